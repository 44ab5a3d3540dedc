//! Sentences about the confidence in a diagnosis and its scope.
use super::effect::named;
use super::value::{equals, nats, odds, p_value};
use crate::diagnosis::subject::DiagnosisInput;
use crate::document::Fact;
use crate::number::{interval, percent, quantity, significant};
use crate::words::condition_name;
use discrepancy::diagnose::ForceEstimate;
use discrepancy::validation::compare::{DataRole, GapRow};
use record::noise::NoiseSource;

/// Lists the sentences that state the confidence in the verdict.
pub(in crate::diagnosis) fn confidence(subject: &DiagnosisInput<'_>) -> Vec<String> {
    let diagnosis = subject.diagnosis();
    let added = subject.added();
    let mut sentences: Vec<String> = added
        .iter()
        .map(|effect| {
            format!(
                "{}: if it were not there, a test as clear as this one anywhere in the library would \
                 have the probability p {}; with every gene fitted again, the record says that it is {}.",
                effect.id,
                equals(&p_value(effect.p_value)),
                likely(effect.ln_evidence)
            )
        })
        .collect();
    if let Some((round, rival)) = diagnosis.rejected()
        && let Some(best) = round.refits.first()
    {
        let behind = (best.log_evidence - rival.log_evidence) / round.dispersion;
        sentences.push(format!(
            "The best rejected rival is {}: on the fitted data the answer is preferred to it ({}); including held-out data, odds of 20 to 1 are required.",
            named(subject, &rival.id),
            odds(behind)
        ));
    }
    if let Some(found) = &diagnosis.force {
        sentences.extend(force(subject, found));
    }
    if !added.is_empty() {
        let unseen = diagnosis
            .rows
            .iter()
            .filter(|row| row.part != DataRole::Fitted);
        sentences.extend(unseen.map(|row| closing(subject, row)));
    }
    if !added.is_empty() {
        sentences.extend(diagnosis.prediction.iter().map(|one| {
            let likelier = if one.nats < 0.0 { "against" } else { "for" };
            format!(
                "{}, {}: these data speak {likelier} the added effects ({}), marginalised over the uncertainty of the fit.",
                condition_name(subject.case, one.condition),
                part(one.part),
                odds(one.nats),
            )
        }));
    }
    let noise = match diagnosis.noise {
        NoiseSource::Measured => None,
        NoiseSource::Stated => Some(
            "The noise was stated, not seen: with one cycle there is no scatter to take it from, so \
             every probability and every limit here is as good as that statement.",
        ),
        NoiseSource::Estimated => Some(
            "The noise is neither measured nor stated: it was estimated from the roughness of the curves, and no effect is named \
             on that basis.",
        ),
    };
    sentences.extend(noise.map(str::to_owned));
    sentences
}

/// States the size of a generic force without a physical cause, and how far this force closes the gap between
/// model and measurement on each held-out record.
fn force(subject: &DiagnosisInput<'_>, force: &ForceEstimate) -> Vec<String> {
    let phase = force.phase_deg.map_or_else(String::new, |phase| {
        format!(", largest at {} deg of its own turn", significant(phase))
    });
    let mut sentences = vec![format!(
        "The force {}: amplitude {} (95\u{a0}% interval {}){phase}; with every gene fitted again, the \
         record says that it is {}.",
        force.id,
        quantity(force.amplitude, &force.unit),
        interval(force.interval, &force.unit),
        likely(force.ln_evidence)
    )];
    let rows = force.rows.iter().filter(|row| row.part != DataRole::Fitted);
    sentences.extend(rows.map(|row| format!("With that force, {}", closing(subject, row))));
    sentences
}

/// States the share of the gap between model and measurement that a change of the model closed or opened, on
/// the data of one row of the comparison.
fn closing(subject: &DiagnosisInput<'_>, row: &GapRow) -> String {
    let closed = row.closed;
    let spread = closed.interval.map_or_else(String::new, |[low, high]| {
        format!(
            " (95\u{a0}% interval {} to {})",
            percent(low),
            percent(high)
        )
    });
    let direction = if closed.closed < 0.0 {
        "opened"
    } else {
        "closed"
    };
    format!(
        "{}, {}: {} of the gap {direction}{spread}.",
        condition_name(subject.case, row.condition),
        data_role(row),
        percent(closed.closed.abs()),
    )
}

/// Lists the gap before and after adding effects with the share that is closed, one fact for each kind of data;
/// the gap alone if nothing was added.
pub(in crate::diagnosis) fn gap_numbers(subject: &DiagnosisInput<'_>) -> Vec<Fact> {
    let diagnosis = subject.diagnosis();
    let changed = !subject.added().is_empty();
    let small = |share: f64| format!("{}\u{a0}%", significant(100.0 * share));
    let gap = |row: &GapRow| {
        let name = format!(
            "gap, {}, {}",
            condition_name(subject.case, row.condition),
            data_role(row)
        );
        let closed = row.closed;
        let value = if changed {
            let interval = closed.interval.map_or_else(String::new, |[low, high]| {
                format!(" (95\u{a0}% {} to {})", percent(low), percent(high))
            });
            format!(
                "{} → {}; {} closed{interval}",
                small(closed.before),
                small(closed.after),
                percent(closed.closed)
            )
        } else {
            small(closed.before)
        };
        Fact::new(name, value)
    };
    diagnosis.rows.iter().map(gap).collect()
}

/// States the odds of an effect against its absence.
fn likely(nats: f64) -> String {
    if nats < 0.0 {
        format!("not there ({})", odds(nats))
    } else {
        format!("there ({})", odds(nats))
    }
}

/// Lists the predictive scores of the answer in nats, by record; `None` where nothing was added or held out.
pub(in crate::diagnosis) fn predictive_scores(subject: &DiagnosisInput<'_>) -> Option<String> {
    let scores = subject.diagnosis().prediction.iter().map(|one| {
        format!(
            "{}, {}: {} nats",
            condition_name(subject.case, one.condition),
            part(one.part),
            nats(one.nats)
        )
    });
    let scores: Vec<String> = scores.collect();
    (!subject.added().is_empty() && !scores.is_empty()).then(|| {
        format!(
            "Gain of the predictive log likelihood of data that took no part: {}.",
            scores.join("; ")
        )
    })
}

/// Returns the role of the data of a comparison row in the fit: fitted, or the kind of hold-out.
pub(in crate::diagnosis) const fn data_role(row: &GapRow) -> &'static str {
    part(row.part)
}

const fn part(part: DataRole) -> &'static str {
    match part {
        DataRole::Fitted => "cycles that were fitted",
        DataRole::Cycles => "held-out cycles",
        DataRole::Channels => "held-out channels",
        DataRole::Segment => "held-out part",
        DataRole::Condition => "another condition, which took no part",
    }
}
