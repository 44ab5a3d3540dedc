//! Quantities of the machine by which the answer of a diagnosis is judged.
use super::condition_curves::condition_curves;
use super::subject::DiagnosisInput;
use crate::kind;
use crate::machine_check::{ComparedChannel, MachineCheck};

/// Returns the quantities of the machine under every compared condition, without and with the added effects; with
/// none added, of the recalibrated model twice.
pub fn checks(subject: &DiagnosisInput<'_>) -> Vec<MachineCheck> {
    let checks = condition_curves(subject).into_iter().flat_map(|shown| {
        let after = shown.after.unwrap_or(shown.before);
        let channels = shown.record.channels.iter().enumerate();
        // a part of a channel has no peak of the whole
        let channels = channels.filter(|(_, own)| own.rows.is_none());
        let channels = channels.filter_map(|(c, own)| {
            Some(ComparedChannel {
                channel: &own.channel,
                measured: shown.mean.get(c)?,
                before: shown.before.get(c)?,
                after: after.get(c)?,
            })
        });
        let channels: Vec<ComparedChannel<'_>> = channels.collect();
        kind::of(subject.case).checks(subject.case, shown.record.condition, &channels, None)
    });
    checks.collect()
}
