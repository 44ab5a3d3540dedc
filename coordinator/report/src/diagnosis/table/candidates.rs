//! Tables of the candidate effects, their tests and their detection limits.
use crate::diagnosis::judgement::{dispersed_p_value, ranked};
use crate::diagnosis::subject::DiagnosisInput;
use crate::diagnosis::words::{self, nats, p_value};
use crate::document::{Row, Table};
use crate::number::{MISSING, percent, quantity, significant};
use discrepancy::diagnose::Round;

/// Builds the table of all candidate effects of a round, with the reason why each was kept or dropped.
pub(in crate::diagnosis) fn candidate_effects(number: usize, round: &Round) -> Table {
    let rows = ranked(round).into_iter().map(|(suspect, judgement)| {
        let score = suspect.score.as_ref();
        Row::new(
            &suspect.effect.id,
            [
                judgement
                    .p_value
                    .map_or_else(|| MISSING.to_owned(), p_value),
                score.map_or_else(|| MISSING.to_owned(), |score| percent(score.absorbed)),
                judgement.gain.map_or_else(|| MISSING.to_owned(), nats),
                judgement.why,
            ],
        )
    });
    Table::new(
        format!("Round {number}: every suspect, and what became of it"),
        [
            "",
            "p of its test",
            "absorbed",
            "nats after refit",
            "kept or dropped, and why",
        ],
        rows.collect(),
    ).with_notes([
        format!(
            "p: probability of a test as clear as this one if the effect is not there, with the \
             noise as many times as large as the best model leaves ({}). Absorbed: share of the effect's \
             signature that recalibration takes up. Nats: gain of the log evidence over the model \
             without it, with all genes free, over the square of that.",
            significant(round.dispersion.sqrt())
        ),
        format!(
            "Over the whole family of named effects, p {}.",
            words::equals(&p_value(round.p_value))
        ),
    ])
}

/// Builds the table of the generic forces with the largest test statistics; `None` if none was tried.
pub(in crate::diagnosis) fn generics(round: &Round) -> Option<Table> {
    const SHOWN: usize = 6;
    let mut forces: Vec<_> = round.generics.iter().collect();
    forces.sort_by(|a, b| b.statistic().total_cmp(&a.statistic()));
    let scale = round.dispersion;
    let rows: Vec<Row> = forces
        .iter()
        .filter(|force| force.statistic() > 0.0)
        .take(SHOWN)
        .map(|force| {
            let p = dispersed_p_value(round, force).map_or_else(|| MISSING.to_owned(), p_value);
            let size = force.score.as_ref().and_then(|score| {
                let first = force.effect.parameters.first()?;
                Some(quantity(score.size.first()? * first.scale, &first.unit))
            });
            Row::new(
                force.effect.title.clone(),
                [
                    significant(force.statistic() / scale),
                    p,
                    size.unwrap_or_else(|| MISSING.to_owned()),
                ],
            )
        })
        .collect();
    Table::new(
        "Forces without a cause that explain most",
        ["", "statistic over dispersion", "p", "amplitude"],
        rows,
    )
    .with_notes([
        "A name must explain more than the best of these: if one of them beats every name by a \
             wide margin, the cause is not in the library.",
    ])
    .non_empty()
}

/// Builds the table of effects that the measured record cannot distinguish, with the additional cycles or
/// records that would distinguish them.
pub(in crate::diagnosis) fn look_alikes(subject: &DiagnosisInput<'_>) -> Option<Table> {
    /// Largest multiple of the recorded number of cycles that is realistic to measure; a larger requirement
    /// is reported as not achievable.
    const MOST: f64 = 30.0;
    let times = |cycles: f64| {
        if cycles <= 1.0 {
            "told apart".to_owned()
        } else if cycles <= MOST {
            format!("{}\u{a0}× the cycles", significant(cycles))
        } else {
            "not by cycles".to_owned()
        }
    };
    let pairs = &subject.diagnosis().look_alikes;
    let rows: Vec<Row> = pairs
        .iter()
        .map(|pair| {
            let others = pair.cycles_with_others;
            Row::new(
                pair.effects.join(", "),
                [
                    times(pair.cycles),
                    others.map_or_else(|| MISSING.to_owned(), times),
                ],
            )
        })
        .collect();
    Table::new(
        "Effects that this record cannot distinguish, and what would distinguish them",
        ["", "with more cycles", "with the other conditions' records"],
        rows,
    )
    .with_notes([
        "Computed at three times the detection limits, independent of the verdict; \
             the most similar pairs first. Pairs that are not listed can be distinguished.",
    ])
    .non_empty()
}

/// Builds the table of detection limits: the smallest size of each effect that the measured record would have
/// shown.
pub(in crate::diagnosis) fn limits(subject: &DiagnosisInput<'_>) -> Option<Table> {
    let limits = subject.diagnosis().detection_limits();
    let rows: Vec<Row> = limits
        .map(|limit| {
            let scale = subject
                .parameter(&limit.id, &limit.parameter)
                .map(|p| p.scale);
            let seen = if limit.size.is_infinite() {
                "never: absorbed".to_owned()
            } else if limit.is_within_bounds() {
                quantity(limit.size, &limit.unit)
            } else {
                let largest = quantity(limit.largest, &limit.unit);
                format!("beyond its bounds, {largest}")
            };
            Row::new(
                format!("{}, {}", limit.id, limit.parameter.replace('_', " ")),
                [
                    seen,
                    scale.map_or_else(|| MISSING.to_owned(), |s| quantity(s, &limit.unit)),
                    scale.map_or_else(
                        || MISSING.to_owned(),
                        |s| crate::number::ratio(limit.size, s),
                    ),
                ],
            )
        })
        .collect();
    Table::new(
            "Detection limits: the size from which this record shows an effect",
            ["", "seen from", "usual size", "limit over usual size"],
            rows,
        ).with_notes([
            "Of effects that are not named: at the recalibrated point, each alone, with the misfit of the \
             model without any: the size that the tests and the evidence asked for would not have \
             missed. A limit well below the usual size means: had it been there, it would have been \
             seen.",]).non_empty()
}
