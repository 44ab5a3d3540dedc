//! Sentences about the confidence in a diagnosis and its scope.
use super::effect::named;
use super::value::{equals, interval, nats, p_value};
use crate::diagnosis::subject::DiagnosisInput;
use crate::document::Fact;
use crate::number::{percent, quantity, significant};
use crate::words::condition_name;
use discrepancy::diagnose::ForceEstimate;
use discrepancy::record::noise::NoiseSource;
use discrepancy::validation::compare::{DataRole, GapRow};

/// Lists the sentences that state the confidence in the verdict.
pub(in crate::diagnosis) fn confidence(subject: &DiagnosisInput<'_>) -> Vec<String> {
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
            "The best rejected rival, {}, lies {} nats behind on the fitted data; including held-out data, at least 3 nats are required.",
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
            .filter(|row| row.part != DataRole::Fitted);
        sentences.extend(unseen.map(|row| closing(subject, row)));
    }
    if !added.is_empty() {
        sentences.extend(diagnosis.prediction.iter().map(|one| {
            let likelier = if one.nats < 0.0 { "less likely" } else { "likelier" };
            format!(
                "{}, {}: with the added effects these data are {} nats {likelier}, marginalised over the uncertainty of the fit.",
                condition_name(subject.case, one.condition),
                part(one.part),
                nats(one.nats.abs()),
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
         record speaks for it by {} nats.",
        force.id,
        quantity(force.amplitude, &force.unit),
        interval(force.interval, &force.unit),
        nats(force.ln_evidence)
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

/// Lists the gap before and after adding effects with the share that is closed, one fact for each kind of data,
/// and the predictive scores; the gap alone if nothing was added.
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
    let mut facts: Vec<Fact> = diagnosis.rows.iter().map(gap).collect();
    if changed {
        facts.extend(diagnosis.prediction.iter().map(|one| {
            let name = format!(
                "predictive score, {}, {}",
                condition_name(subject.case, one.condition),
                part(one.part)
            );
            Fact::new(
                name,
                format!("{} nats for the added effects", nats(one.nats)),
            )
        }));
    }
    facts
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
        DataRole::LeftOut => "blocks of the record, left out in turn",
    }
}
