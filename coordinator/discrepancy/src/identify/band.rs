//! Prediction bands of every channel under every condition.
//!
//! A band is the envelope of all curves compatible with the record: the linear band, with each unknown
//! limited to its own interval, and the curves at the outermost point of each side of the profiles. It is a
//! band of the simulated curve and does not include measurement noise.
use super::answer::{Band, BandCurve, IntervalEnd, Sensitivity};
use super::profile::{NEAR, ProfilePoint, ProfileStep};
use super::profiles::Profiles;
use crate::laboratory::{Laboratory, channels};
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use nalgebra::{DMatrix, DVector};
use protocol::case::Channel;
use record::{Curves, Record, Recorded, Stated};

/// Maximum rise of the cost at a profile point that counts as compatible with the record, as a multiple of
/// the rise at the end of an interval.
const INSIDE: f64 = 1.0 + NEAR;

/// Computes, for every condition, the curves at a fit, their derivatives by every variable, and the curves at
/// the outermost points compatible with the record. Conditions under which the fit fails are omitted.
pub(super) async fn sights<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    walked: &Profiles,
    conditions: &[Vec<Channel>],
) -> Result<Vec<Sensitivity>, L::Error> {
    let fit = &walked.fit;
    let least = fit.search.cost();
    let inside = walked.sides.iter().filter_map(|side| {
        let marks = side.marks.iter();
        let kept = marks.filter(|mark| mark.cost - least <= INSIDE * walked.rises[side.unknown]);
        let away = |mark: &&ProfilePoint| side.sign * mark.at;
        kept.max_by(|a, b| away(a).total_cmp(&away(b)))
    });
    let inside: Vec<&[f64]> = inside.map(|mark| mark.x.as_slice()).collect();
    let mut sights = Vec::new();
    for (condition, channels_of) in conditions.iter().enumerate() {
        let record = blank(condition, channels_of);
        let Some(seen) = experiments.linearized(fit, &record).await? else {
            continue;
        };
        let numerics = &experiments.on.numerics;
        let batch = inside.iter();
        let batch = batch.map(|x| fit.at(x.to_vec()).experiment(condition, numerics));
        let observed = experiments.lab.observe(experiments.stage, batch.collect());
        let observed = observed.await?.into_iter();
        let others = observed.filter_map(|seen| channels(&seen?, &record));
        sights.push(Sensitivity {
            condition,
            curves: ungained(fit, &record, seen.curves),
            changes: seen.changes,
            others: others.collect(),
        });
    }
    Ok(sights)
}

/// Creates a record of all channels of a condition, without measured values.
fn blank(condition: usize, channels: &[Channel]) -> Record {
    let channels = channels.iter().enumerate();
    Record {
        condition,
        channels: channels
            .map(|(k, channel)| Recorded::new(k, channel))
            .collect(),
        cycles: Vec::new(),
        held_out: false,
        stated: Stated::default(),
    }
}

/// Divides the curves by the estimated gains of the instruments, which leaves the true quantities.
fn ungained(fit: &Fit, record: &Record, mut curves: Curves) -> Curves {
    for (place, one) in fit.model.indexed_nuisances() {
        if let Some(channel) = one.channel(record) {
            let gain = 1.0 + fit.x()[place] * one.nuisance.deviation;
            for y in &mut curves[channel] {
                *y /= gain;
            }
        }
    }
    curves
}

/// Returns the covariance of the variables from a Jacobian, including dispersion and autocorrelation of the
/// residual. An unknown that the record does not bound on both sides is limited to its own interval by a
/// prior; `None` if the information matrix is singular.
pub(super) fn covariance(walked: &Profiles, jacobian: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let fit = &walked.fit;
    let spread = &walked.spread;
    let scaled = jacobian / spread.dispersion.sqrt();
    let mut information = super::information::with_priors(&scaled, fit.variables());
    for (k, _) in fit.model.space.axes().iter().enumerate() {
        let (mut width, mut seen) = (0.0, true);
        for side in walked.of(k) {
            if let ProfileStep::Over(end, at) = walked.end(side) {
                width += (at - fit.x()[k]).abs();
                seen &= end == IntervalEnd::Rises;
            }
        }
        if seen {
            continue;
        }
        let deviation = 0.5 * width / (spread.quantile * spread.growth[k]);
        if deviation > 0.0 {
            information[(k, k)] += 1.0 / (deviation * deviation);
        }
    }
    let mut covariance = super::information::inverse(information)?;
    for (k, growth) in spread.growth.iter().enumerate() {
        covariance.row_mut(k).scale_mut(*growth);
        covariance.column_mut(k).scale_mut(*growth);
    }
    Some(covariance)
}

/// Computes the prediction bands of all channels under a condition.
pub(super) fn band(walked: &Profiles, sight: &Sensitivity) -> Band {
    let covariance = covariance(walked, &walked.fit.search.best().jacobian);
    let gains: Vec<usize> = walked
        .fit
        .model
        .indexed_nuisances()
        .filter(|(_, one)| one.effect().is_none())
        .map(|(place, _)| place)
        .collect();
    let channel = |c: usize| {
        let likeliest = sight.curves[c].clone();
        let half = |t: usize| {
            let column = |k: usize| match &sight.changes[k] {
                // what an instrument reads is not what is predicted
                Some(change) if !gains.contains(&k) => change[c][t],
                Some(_) | None => 0.0,
            };
            let columns = DVector::from_fn(sight.changes.len(), |k, _| column(k));
            let variance = covariance
                .as_ref()
                .map_or(0.0, |own| columns.dot(&(own * &columns)));
            walked.spread.quantile * variance.max(0.0).sqrt()
        };
        let mut low = likeliest.clone();
        let mut high = likeliest.clone();
        for t in 0..likeliest.len() {
            let half = half(t);
            low[t] -= half;
            high[t] += half;
            for other in &sight.others {
                low[t] = low[t].min(other[c][t]);
                high[t] = high[t].max(other[c][t]);
            }
        }
        BandCurve {
            likeliest,
            low,
            high,
        }
    };
    Band {
        condition: sight.condition,
        channels: (0..sight.curves.len()).map(channel).collect(),
    }
}
