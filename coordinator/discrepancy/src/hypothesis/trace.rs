//! Traces: effects that change no channel by more than models of real machines err anyway.
use crate::baseline::base::Baseline;
use crate::model::fit::Fit;
use crate::thresholds::{LAW_FLOOR, MODEL_FLOOR};
use record::{Record, Recorded, power};

/// Largest change of a channel by an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LargestChange {
    /// Index of the channel in the record.
    pub(crate) channel: usize,
    /// Root mean square of the change over that of the measured curve \[1\].
    pub(crate) share: f64,
    /// Root mean square of the change over the model error of the channel \[1\].
    pub(crate) ratio: f64,
}

impl LargestChange {
    /// Returns the reason why the effects `ids` are no more than traces, if they are.
    pub(crate) fn trace(&self, ids: &str, record: &Record) -> Option<String> {
        let channel = &record.channels[self.channel].channel.title;
        (self.ratio < 1.0).then(|| {
            format!(
                "{ids} is no more than a trace: it changes no channel by more than models of real machines err, {channel} by \
                 {:.2} % of its root mean square",
                100.0 * self.share
            )
        })
    }
}

/// Returns the change of the channel that an effect, added to a refitted model, changes most relative to the model
/// error of the channel. That error is the largest of the stated `model_error`, the part of the numerical check that
/// recalibration leaves, [`MODEL_FLOOR`] of the measured curve, and [`LAW_FLOOR`] of the change by the effects that
/// the model without it has. Curves without a fixed zero count without their
/// mean. `None` without a channel.
pub(crate) fn largest_change(base: &Baseline, [without, with]: [&Fit; 2]) -> Option<LargestChange> {
    let record = &base.record.record;
    let mean = record.mean();
    let channels = record.channels.iter().enumerate();
    let change = |(c, own): (usize, &Recorded)| {
        let absolute = own.channel.is_absolute();
        let change = |to: &Fit, from: &Fit| {
            let curves = to.curves[c].iter().zip(&from.curves[c]);
            let changed: Vec<f64> = curves.map(|(a, b)| a - b).collect();
            power(&changed, absolute).sqrt()
        };
        let changed = change(with, without);
        let measured = power(&mean[c], absolute).sqrt();
        let numerical = base.preflight.as_ref().map_or(0.0, |own| own.rms_left[c]);
        let error = (MODEL_FLOOR * measured)
            .max(LAW_FLOOR * change(without, &base.fit))
            .max(own.model_error.unwrap_or(0.0))
            .max(numerical);
        LargestChange {
            channel: c,
            share: changed / measured.max(f64::MIN_POSITIVE),
            ratio: changed / error.max(f64::MIN_POSITIVE),
        }
    };
    channels
        .map(change)
        .max_by(|a, b| a.ratio.total_cmp(&b.ratio))
}
