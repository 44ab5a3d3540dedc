//! How sure a diagnosis is, and how far it reaches: one sentence per ground.
use super::effect::named;
use super::value::{equals, interval, nats, p_value};
use crate::diagnosis::subject::Subject;
use crate::number::{figure, percent, quantity};
use crate::words::condition_name;
use discrepancy::diagnose::Force;
use discrepancy::proof::compare::{Portion, Row};
use discrepancy::record::noise::Known;

/// How sure the verdict is.
pub(in crate::diagnosis) fn confidence(subject: &Subject<'_>) -> Vec<String> {
    let diagnosis = subject.diagnosis();
    let added = subject.added();
    let mut sentences: Vec<String> = added
        .iter()
        .map(|effect| {
            format!(
                "{}: if it were not there, a test as clear as this one anywhere in the library would \
                 have the probability p {}; with every gene fitted again, the record speaks for it by \
                 {} nats.",
                effect.id,
                equals(&p_value(effect.p_value)),
                nats(effect.ln_evidence)
            )
        })
        .collect();
    if let Some((round, rival)) = diagnosis.rejected()
        && let Some(best) = round.refits.first()
    {
        let behind = (best.log_evidence - rival.log_evidence) / round.dispersion;
        sentences.push(format!(
            "The best rejected rival, {}, lies {} nats behind on what was fitted; with what took no part, 3 are asked for.",
            named(subject, &rival.id),
            nats(behind)
        ));
    }
    if let Some(found) = &diagnosis.force {
        sentences.extend(force(subject, found));
    }
    if !added.is_empty() {
        let unseen = diagnosis
            .rows
            .iter()
            .filter(|row| row.part != Portion::Fitted);
        sentences.extend(unseen.map(|row| closing(subject, row)));
    }
    if !added.is_empty() {
        sentences.extend(diagnosis.prediction.iter().map(|one| {
            let likelier = if one.nats < 0.0 { "less likely" } else { "likelier" };
            format!(
                "{}, {}: with what was added it is {} nats {likelier}, what the fit leaves open integrated out.",
                condition_name(subject.case, one.condition),
                part(one.part),
                nats(one.nats.abs()),
            )
        }));
    }
    let noise = match diagnosis.noise {
        Known::Seen => None,
        Known::Stated => Some(
            "The noise was stated, not seen: with one cycle there is no scatter to take it from, so \
             every probability and every limit here is as good as that statement.",
        ),
        Known::Guessed => Some(
            "The noise is neither seen nor stated: it was guessed from how rough the curves are, and nothing is named \
             on a guess.",
        ),
    };
    sentences.extend(noise.map(str::to_owned));
    sentences
}

/// The size of a force without a cause, and by how much it closes the gap on each record.
fn force(subject: &Subject<'_>, force: &Force) -> Vec<String> {
    let phase = force.phase_deg.map_or_else(String::new, |phase| {
        format!(", largest at {} deg of its own turn", figure(phase))
    });
    let mut sentences = vec![format!(
        "The force {}: amplitude {} (95\u{a0}% interval {}){phase}; with every gene fitted again, the \
         record speaks for it by {} nats.",
        force.id,
        quantity(force.amplitude, &force.unit),
        interval(force.interval, &force.unit),
        nats(force.ln_evidence)
    )];
    let rows = force.rows.iter().filter(|row| row.part != Portion::Fitted);
    sentences.extend(rows.map(|row| format!("With that force, {}", closing(subject, row))));
    sentences
}

/// By how much the gap of a row closed.
fn closing(subject: &Subject<'_>, row: &Row) -> String {
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
        role(row),
        percent(closed.closed.abs()),
    )
}

/// What a row's cycles were to the fit.
pub(in crate::diagnosis) const fn role(row: &Row) -> &'static str {
    part(row.part)
}

const fn part(part: Portion) -> &'static str {
    match part {
        Portion::Fitted => "cycles that were fitted",
        Portion::Cycles => "held-out cycles",
        Portion::Channels => "held-out channels",
        Portion::Segment => "held-out part",
        Portion::Condition => "another condition, which took no part",
        Portion::LeftOut => "blocks of the record, left out in turn",
    }
}
