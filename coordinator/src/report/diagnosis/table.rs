//! The tables of a diagnosis: for the page and for the terminal.
use super::Subject;
use super::judgement::{ranked, tempered};
use super::shown::{Shown, shown};
use super::words::{self, interval, nats, p_value, quantity};
use crate::report::number::{NONE, count, duration, figure, fixed, percent, unit};
use crate::report::table::{Label, Row, Table};
use crate::report::words::{at_bound, condition_name};
use discrepancy::diagnose::Round;
use discrepancy::record::Source;
use discrepancy::stage::show;
use protocol::announce::{ParameterDescriptor, Role};

fn table<const N: usize>(title: impl Into<String>, head: [&str; N], rows: Vec<Row>) -> Table {
    Table {
        title: title.into(),
        head: head.map(str::to_owned).to_vec(),
        rows,
        notes: Vec::new(),
    }
}

fn row(label: impl Into<String>, cells: impl IntoIterator<Item = String>) -> Row {
    Row::Values(Label::Text(label.into()), cells.into_iter().collect())
}

/// Every suspect of a round, with what became of it.
pub(super) fn suspects(number: usize, round: &Round) -> Table {
    let rows = ranked(round).into_iter().map(|(suspect, judgement)| {
        let score = suspect.score.as_ref();
        row(
            &suspect.effect.id,
            [
                judgement.p_value.map_or_else(|| NONE.to_owned(), p_value),
                score.map_or_else(|| NONE.to_owned(), |score| percent(score.absorbed)),
                judgement.gain.map_or_else(|| NONE.to_owned(), nats),
                judgement.why,
            ],
        )
    });
    let mut made = table(
        format!("Round {number}: every suspect, and what became of it"),
        [
            "",
            "p of its test",
            "absorbed",
            "nats after refit",
            "kept or dropped, and why",
        ],
        rows.collect(),
    );
    made.notes = vec![
        format!(
            "p: probability of a test as clear as this one if the effect is not there, with the \
             variances inflated by the misfit of the best model ({}²). Absorbed: share of the effect's \
             signature that recalibration takes up. Nats: gain of the log evidence over the model \
             without it, with all genes free, over the squared misfit.",
            figure(round.phi)
        ),
        format!(
            "Over the whole family of named effects, p {}.",
            words::equals(&p_value(round.p_value))
        ),
    ];
    made
}

/// The forces without a cause that explain most; none where none was tried.
pub(super) fn generics(round: &Round) -> Option<Table> {
    const SHOWN: usize = 6;
    let mut forces: Vec<_> = round.generics.iter().collect();
    forces.sort_by(|a, b| b.statistic().total_cmp(&a.statistic()));
    let scale = round.phi * round.phi;
    let rows: Vec<Row> = forces
        .iter()
        .filter(|force| force.statistic() > 0.0)
        .take(SHOWN)
        .map(|force| {
            let p = tempered(round, force).map_or_else(|| NONE.to_owned(), p_value);
            let size = force.score.as_ref().and_then(|score| {
                let first = force.effect.parameters.first()?;
                Some(quantity(score.size.first()? * first.scale, &first.unit))
            });
            row(
                force.effect.title.clone(),
                [
                    figure(force.statistic() / scale),
                    p,
                    size.unwrap_or_else(|| NONE.to_owned()),
                ],
            )
        })
        .collect();
    (!rows.is_empty()).then(|| {
        let mut made = table(
            "Forces without a cause that explain most",
            ["", "statistic over squared misfit", "p", "amplitude"],
            rows,
        );
        made.notes = vec![
            "A name must explain more than the best of these: if one of them beats every name by a \
             wide margin, the cause is not in the library."
                .to_owned(),
        ];
        made
    })
}

/// Parameters of the effects of the answer.
pub(super) fn sizes(subject: &Subject<'_>) -> Option<Table> {
    let mut rows = Vec::new();
    for effect in &subject.diagnosed.diagnosis.effects {
        rows.push(Row::Group(format!("{} ({})", effect.title, effect.id)));
        for (name, unit, value, ci95) in &effect.parameters {
            let known = words::parameter(subject, &effect.id, name);
            let of = |value: Option<f64>| {
                value.map_or_else(|| NONE.to_owned(), |value| quantity(value, unit))
            };
            rows.push(row(
                name.replace('_', " "),
                [
                    quantity(*value, unit),
                    interval(*ci95, unit),
                    of(known.map(usual)),
                    known.map_or_else(|| NONE.to_owned(), |p| interval([p.lower, p.upper], unit)),
                    known
                        .and_then(|p| edge(*value, p.lower, p.upper))
                        .unwrap_or("")
                        .to_owned(),
                ],
            ));
        }
    }
    (!rows.is_empty()).then(|| {
        let mut made = table(
            "Sizes of the answer",
            ["", "value", "95\u{a0}% interval", "usual size", "bounds", ""],
            rows,
        );
        made.notes = vec![
            "Intervals are those of the linearised fit with all genes free, inflated by its misfit; \
             they hold if the name is right."
                .to_owned(),
        ];
        made
    })
}

/// How large a parameter usually is: of a shape, its typical value.
fn usual(parameter: &ParameterDescriptor) -> f64 {
    match parameter.role {
        Role::Size => parameter.scale,
        Role::Shape => parameter.typical,
    }
}

/// Which bound a value on a linear scale touches.
fn edge(value: f64, lower: f64, upper: f64) -> Option<&'static str> {
    let share = (value - lower) / (upper - lower);
    match share {
        _ if share < 0.005 => Some("at its lower bound"),
        _ if share > 0.995 => Some("at its upper bound"),
        _ => None,
    }
}

/// From which size on each effect would have been seen.
pub(super) fn limits(subject: &Subject<'_>) -> Option<Table> {
    let limits = &subject.diagnosed.diagnosis.limits;
    let rows: Vec<Row> = limits
        .iter()
        .map(|limit| {
            let scale = words::parameter(subject, &limit.id, &limit.parameter).map(|p| p.scale);
            let seen = if limit.size.is_finite() {
                quantity(limit.size, &limit.unit)
            } else {
                "never: absorbed".to_owned()
            };
            row(
                format!("{}, {}", limit.id, limit.parameter.replace('_', " ")),
                [
                    seen,
                    scale.map_or_else(|| NONE.to_owned(), |s| quantity(s, &limit.unit)),
                    scale.map_or_else(
                        || NONE.to_owned(),
                        |s| crate::report::number::ratio(limit.size, s),
                    ),
                ],
            )
        })
        .collect();
    (!rows.is_empty()).then(|| {
        let mut made = table(
            "Detection limits: the size from which this record shows an effect",
            ["", "seen from", "usual size", "limit over usual size"],
            rows,
        );
        made.notes = vec![
            "Before any verdict, at the recalibrated point, each effect alone, with the misfit of the \
             model without any: the size that the tests and the evidence asked for would not have \
             missed. A limit well below the usual size means: had it been there, it would have been \
             seen."
                .to_owned(),
        ];
        made
    })
}

/// The gap before and after, of the answer and of the best rejected rival.
pub(super) fn gaps(subject: &Subject<'_>) -> Option<Table> {
    let diagnosis = &subject.diagnosed.diagnosis;
    let added = words::added(diagnosis).next().is_some();
    let mut rows: Vec<Row> = Vec::new();
    if !diagnosis.rows.is_empty() {
        let whose = if added {
            "the answer"
        } else {
            "the recalibrated model, to which nothing was added"
        };
        rows.push(Row::Group(whose.to_owned()));
        rows.extend(diagnosis.rows.iter().map(|row| gap(subject, row, added)));
    }
    if let Some((id, rival)) = &diagnosis.rival {
        rows.push(Row::Group(format!("the best rejected rival, {id}")));
        rows.extend(rival.iter().map(|row| gap(subject, row, true)));
    }
    (!rows.is_empty()).then(|| {
        let mut made = table(
            "The gap before and after",
            ["", "before", "after", "closed", "95\u{a0}% interval"],
            rows,
        );
        made.notes = vec![
            "Gap: mean over the gauges of the squared residual above the noise of the averaged record, \
             over the variance of the measured curve; means removed. Interval: the cycles drawn again \
             1000 times, before and after on the same draw."
                .to_owned(),
            "A gap that closes does not prove a name: a wrong effect often closes most of it, which is \
             why the rival stands beside it."
                .to_owned(),
        ];
        made
    })
}

/// One row of it; without a change there is nothing after and nothing closed.
fn gap(subject: &Subject<'_>, of: &show::Row, changed: bool) -> Row {
    let small = |share: f64| {
        if share.is_finite() {
            format!("{}\u{a0}%", figure(100.0 * share))
        } else {
            NONE.to_owned()
        }
    };
    row(
        format!(
            "{}, {}",
            condition_name(subject.case, of.condition),
            words::role(subject, of)
        ),
        [
            small(of.closed.before),
            if changed {
                small(of.closed.after)
            } else {
                NONE.to_owned()
            },
            if changed {
                percent(of.closed.closed)
            } else {
                NONE.to_owned()
            },
            of.closed.interval.filter(|_| changed).map_or_else(
                || NONE.to_owned(),
                |[low, high]| format!("{} to {}", percent(low), percent(high)),
            ),
        ],
    )
}

/// The paper's two error measures, gauge by gauge.
pub(super) fn paper(subject: &Subject<'_>) -> Option<Table> {
    let mut rows = Vec::new();
    for shown in shown(subject) {
        let gauges = |c: &usize| matches!(shown.record.channels[*c], Source::Gauge(_));
        let order: Vec<usize> = shown.order().into_iter().filter(gauges).collect();
        if order.is_empty() {
            continue;
        }
        rows.push(Row::Group(format!("condition {}", shown.condition)));
        rows.extend(order.into_iter().filter_map(|c| errors(&shown, c)));
    }
    (!rows.is_empty()).then(|| {
        let mut made = table(
            "The same in the reference paper's measures",
            [
                "",
                "MSE before [MPa²]",
                "after",
                "rival",
                "relative error before",
                "after",
                "rival",
            ],
            rows,
        );
        made.notes = vec![
            "MSE: mean squared difference of the measured mean and the simulated curve, with the offset \
             as the case's objective treats it; noise included. Relative error: mean absolute difference \
             over the mean absolute deviation of the measured curve from its own mean."
                .to_owned(),
        ];
        made
    })
}

fn errors(shown: &Shown<'_>, c: usize) -> Option<Row> {
    let name = shown.record.channels[c].name();
    let of = shown.channel(c, &name)?;
    let n = of.measured.len() as f64;
    let mean = of.measured.iter().sum::<f64>() / n;
    let deviation = of.measured.iter().map(|m| (m - mean).abs()).sum::<f64>();
    let square = |simulated: &[f64]| {
        let residual = of.residual(simulated);
        figure(residual.iter().map(|r| r * r).sum::<f64>() / n)
    };
    let relative = |simulated: &[f64]| {
        let residual = of.residual(simulated);
        percent(residual.iter().map(|r| r.abs()).sum::<f64>() / deviation)
    };
    let all = [Some(of.before), of.after, of.rival.map(|(_, rival)| rival)];
    let cells = all
        .map(|s| s.map_or_else(|| NONE.to_owned(), square))
        .into_iter()
        .chain(all.map(|s| s.map_or_else(|| NONE.to_owned(), relative)));
    Some(row(&name, cells.collect::<Vec<_>>()))
}

/// How far the discretisation moves each channel.
pub(super) fn numerics(subject: &Subject<'_>) -> Option<Table> {
    let preflight = subject.diagnosed.diagnosis.preflight.as_ref()?;
    let record = words::calibrated(subject)?;
    let rows = record.channels.iter().enumerate().map(|(c, source)| {
        let of = |values: &[f64]| {
            values
                .get(c)
                .map_or_else(|| NONE.to_owned(), |value| quantity(*value, source.unit()))
        };
        row(
            source.name(),
            [
                of(&preflight.rms),
                of(&preflight.rms_left),
                of(&preflight.standard_error),
            ],
        )
    });
    let mut made = table(
        "Numerical check: the finer model less the one that is fitted, root mean square",
        [
            "",
            "difference",
            "after recalibration",
            "standard error of the mean",
        ],
        rows.collect(),
    );
    made.notes = vec![format!(
        "What recalibration leaves of the difference is at most {} of the standard error; it counts as \
         noise in every test, so that no effect is named for what a coarser rope does.",
        if preflight.ratio().is_finite() {
            format!("{}\u{a0}×", fixed(preflight.ratio(), 2))
        } else {
            "an unknown multiple".to_owned()
        }
    )];
    Some(made)
}

/// Genes before and after, with their bounds.
pub(super) fn genes(subject: &Subject<'_>) -> Option<Table> {
    let diagnosis = &subject.diagnosed.diagnosis;
    let before = diagnosis
        .before
        .as_ref()
        .map(|fit| fit.model.genes(fit.x()))?;
    let after = diagnosis.after.as_ref().map(|fit| fit.model.genes(fit.x()));
    let rows = subject.case.genes.iter().enumerate().map(|(k, gene)| {
        let of = |value: Option<&f64>| value.map_or_else(|| NONE.to_owned(), |v| figure(*v));
        let last = after.as_ref().unwrap_or(&before).get(k);
        let edge = last.and_then(|v| at_bound(gene.lower, gene.upper, *v));
        Row::Values(
            Label::Gene(gene.name),
            vec![
                figure(gene.recommended),
                of(before.get(k)),
                of(after.as_ref().and_then(|after| after.get(k))),
                interval([gene.lower, gene.upper], unit(gene.unit)),
                edge.map_or_else(String::new, |edge| format!("at its {edge} bound")),
            ],
        )
    });
    Some(table(
        "Parameters of the calibration",
        [
            "",
            "recommended",
            "recalibrated",
            "with the answer",
            "bounds",
            "",
        ],
        rows.collect(),
    ))
}

/// What each stage cost.
pub(super) fn stages(subject: &Subject<'_>) -> Option<Table> {
    let accounts = &subject.diagnosed.accounts;
    let mut rows: Vec<Row> = accounts
        .iter()
        .map(|(stage, account)| {
            row(
                stage.name(),
                [
                    count(account.experiments),
                    count(account.failed),
                    duration(account.wall.as_secs_f64()),
                ],
            )
        })
        .collect();
    let total = |of: fn(&crate::study::Account) -> u64| accounts.iter().map(|(_, a)| of(a)).sum();
    rows.push(row(
        "all",
        [
            count(total(|account| account.experiments)),
            count(total(|account| account.failed)),
            duration(subject.wall_s),
        ],
    ));
    (!accounts.is_empty()).then(|| {
        let mut made = table(
            "What each stage cost",
            ["", "simulations", "did not complete", "time in this session"],
            rows,
        );
        made.notes = vec![
            "Results that the journal held already take no time; the last line's time is that of all \
             sessions."
                .to_owned(),
        ];
        made
    })
}
