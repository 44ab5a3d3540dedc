//! Estimates of the unknowns with intervals from their profiles.
use super::answer::{Determination, IntervalEnd, UnknownEstimate};
use super::information::correlation;
use super::profile::ProfileStep;
use super::profiles::Profiles;
use crate::model::fit::Fit;
use search::space::Axis;

/// Absolute correlation above which two unknowns are reported as correlated.
const TRADES: f64 = 0.7;

/// Returns the estimates of all unknowns of a fit, with intervals from their profiles.
pub(super) fn estimates(walked: &Profiles) -> Vec<UnknownEstimate> {
    (0..walked.fit.model.space.dimension())
        .map(|k| estimate(walked, k))
        .collect()
}

/// Returns the values of all unknowns of a fit, without intervals.
pub(super) fn values(fit: &Fit) -> Vec<UnknownEstimate> {
    let axes = fit.model.space.axes().iter().zip(fit.x());
    let value = |(axis, x): (&Axis, &f64)| UnknownEstimate {
        name: axis.unknown.name.clone(),
        unit: axis.unknown.unit.clone(),
        value: axis.value(*x),
        interval: [None; 2],
        ends: [IntervalEnd::NotFollowed; 2],
        seen: Determination::NotSeen,
        correlated: Vec::new(),
        profile: Vec::new(),
    };
    axes.map(value).collect()
}

fn estimate(walked: &Profiles, k: usize) -> UnknownEstimate {
    let axes = walked.fit.model.space.axes();
    let axis = &axes[k];
    let mut interval = [None; 2];
    let mut ends = [IntervalEnd::Bound; 2];
    for (place, side) in walked.of(k).enumerate().take(2) {
        if let ProfileStep::Over(end, at) = walked.end(side) {
            ends[place] = end;
            interval[place] = (end == IntervalEnd::Rises).then(|| axis.value(at));
        }
    }
    let correlated = walked.covariance.iter().flat_map(|covariance| {
        let others = (0..axes.len()).filter(move |j| *j != k);
        others.map(move |j| (axes[j].unknown.name.clone(), correlation(covariance, k, j)))
    });
    let mut correlated: Vec<(String, f64)> =
        correlated.filter(|(_, c)| c.abs() >= TRADES).collect();
    correlated.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    UnknownEstimate {
        name: axis.unknown.name.clone(),
        unit: axis.unknown.unit.clone(),
        value: axis.value(walked.fit.x()[k]),
        interval,
        ends,
        seen: Determination::of(ends[0] == IntervalEnd::Rises, ends[1] == IntervalEnd::Rises),
        correlated,
        profile: profile(walked, k),
    }
}

/// Returns the profile as pairs of value and rise of `-2 ln L`, scaled so that the rise is 3.84 at the ends
/// of the interval.
fn profile(walked: &Profiles, k: usize) -> Vec<[f64; 2]> {
    let axis = &walked.fit.model.space.axes()[k];
    let cost = walked.fit.search.cost();
    let scale = super::profile::RISE / walked.rises[k];
    let mut all: Vec<[f64; 2]> = walked
        .of(k)
        .flat_map(|side| &side.marks)
        .map(|mark| [axis.value(mark.at), scale * (mark.cost - cost).max(0.0)])
        .collect();
    all.push([axis.value(walked.fit.x()[k]), 0.0]);
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    all
}
