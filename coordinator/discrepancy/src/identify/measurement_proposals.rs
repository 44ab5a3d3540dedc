//! Value of further measurements: another channel, another condition, more cycles.
//!
//! The computation is linear at the fit. A channel that was never recorded is assumed to have the noise of a
//! recorded channel of the same unit.
use super::answer::{DeterminedUnknown, FurtherMeasurement, Sensitivity};
use super::band::covariance;
use super::profiles::Profiles;
use crate::inputs::Inputs;
use crate::linear::stack::stacked;
use crate::linear::whitened::WhitenedRecord;
use nalgebra::DMatrix;
use protocol::case::Channel;
use record::{Curves, Record, Recorded};

/// Factor on the number of cycles in the hypothetical measurement with more cycles.
const CYCLES: f64 = 4.0;
/// Ratio of new to present standard deviation below which an unknown counts as determined by a measurement.
const PINNED: f64 = 0.5;
/// Maximum number of proposed further measurements that are reported.
const TOLD: usize = 8;

/// Returns the possible further measurements that would determine at least one unknown, most informative
/// first.
pub(super) fn further(
    walked: &Profiles,
    sights: &[Sensitivity],
    (inputs, on): (&Inputs, &WhitenedRecord),
    conditions: &[Vec<Channel>],
) -> Vec<FurtherMeasurement> {
    let jacobian = &walked.fit.search.best().jacobian;
    let mut all = Vec::new();
    let more = jacobian * CYCLES.sqrt();
    all.push(weigh(
        walked,
        &more,
        format!("{CYCLES:.0} times as many cycles"),
    ));
    for sight in sights {
        let channels = &conditions[sight.condition];
        let calibrated = sight.condition == on.record.condition;
        let candidates: Vec<(Record, String)> = if calibrated {
            unrecorded(&on.record, channels)
        } else {
            let name = conditions_words(inputs, &on.record, sight.condition, channels);
            name.into_iter().collect()
        };
        for (record, words) in candidates {
            let highest = inputs.thresholds.orders;
            let own = WhitenedRecord::under_own_noise(record, highest, on.numerics.clone());
            let below = columns(&own, sight);
            let both = stacked(jacobian, &below);
            all.push(weigh(walked, &both, words));
        }
    }
    all.retain(|one| !one.pins.is_empty());
    let told = |one: &FurtherMeasurement| {
        let gains = one
            .pins
            .iter()
            .map(|pin| libm::log(pin.sd_now / pin.sd_then));
        gains.sum::<f64>()
    };
    all.sort_by(|a, b| told(b).total_cmp(&told(a)));
    all.truncate(TOLD);
    all
}

/// Returns the channels of the fitted condition that the record lacks, each with the noise of a recorded
/// channel of the same unit.
fn unrecorded(record: &Record, channels: &[Channel]) -> Vec<(Record, String)> {
    let lacks = |curve: &usize| record.channels.iter().all(|own| own.curve != *curve);
    let candidate = |curve: usize| {
        let channel = &channels[curve];
        let mut own = record.channels.iter();
        let places = channel.abscissa.points.len();
        let whole =
            |own: &Recorded| own.rows.is_none() && own.channel.abscissa.points.len() == places;
        let like = own.position(|own| own.channel.unit == channel.unit && whole(own))?;
        let cycle = |cycle: &Curves| vec![cycle[like].clone()];
        let mut blank = record.clone();
        blank.cycles = record.cycles.iter().map(cycle).collect();
        blank.channels = vec![Recorded::new(curve, channel)];
        blank.stated.cycle_variance = Vec::new();
        let words = format!("{} in addition to the recorded channels", channel.title);
        Some((blank, words))
    };
    (0..channels.len())
        .filter(lacks)
        .filter_map(candidate)
        .collect()
}

/// Returns the record of another condition if there is one, otherwise a hypothetical record with the channels
/// and the noise of the fitted condition; with its description.
fn conditions_words(
    inputs: &Inputs,
    fitted: &Record,
    condition: usize,
    channels: &[Channel],
) -> Option<(Record, String)> {
    let mut recorded = inputs.records.iter().skip(1);
    let recorded = recorded.find(|record| record.condition == condition);
    if let Some(record) = recorded.filter(|record| !record.cycles.is_empty()) {
        let words = format!(
            "the record of {}, fitted as well",
            inputs.condition(condition)
        );
        return Some((record.clone(), words));
    }
    let same = |own: &Recorded| {
        let curve = channels.iter().position(|c| c.name == own.channel.name)?;
        let points = channels[curve].abscissa.points.len();
        let last = own.rows.as_ref().and_then(|rows| rows.last());
        let fits = last.map_or(points == own.channel.abscissa.points.len(), |k| *k < points);
        fits.then(|| {
            let whole = Recorded::new(curve, &channels[curve]);
            let rows = own.rows.clone();
            rows.map_or_else(|| whole.clone(), |rows| whole.part(rows, false))
        })
    };
    let channels: Option<Vec<Recorded>> = fitted.channels.iter().map(same).collect();
    let record = Record {
        condition,
        channels: channels?,
        ..fitted.clone()
    };
    let words = format!("the same channels under {}", inputs.condition(condition));
    Some((record, words))
}

/// Returns the Jacobian of the whitened residual of a possible further record; columns of unknown derivatives
/// are zero.
fn columns(on: &WhitenedRecord, sight: &Sensitivity) -> DMatrix<f64> {
    let mut columns = DMatrix::zeros(on.metric.len(), sight.changes.len());
    for (k, change) in sight.changes.iter().enumerate() {
        let Some(change) = change else { continue };
        let own: Curves = on
            .record
            .channels
            .iter()
            .filter_map(|own| own.pick(&change[own.curve]))
            .collect();
        columns.set_column(k, &-on.metric.whiten(&own));
    }
    columns
}

/// Returns the unknowns that a further measurement would determine; `jacobian` stacks its rows below those of
/// the present record.
fn weigh(walked: &Profiles, jacobian: &DMatrix<f64>, measurement: String) -> FurtherMeasurement {
    let own = &walked.fit.search.best().jacobian;
    let (Some(now), Some(then)) = (covariance(walked, own), covariance(walked, jacobian)) else {
        return FurtherMeasurement {
            measurement,
            pins: Vec::new(),
        };
    };
    let axes = walked.fit.model.space.axes().iter().enumerate();
    let pin = axes.map(|(k, axis)| DeterminedUnknown {
        name: axis.unknown.name.clone(),
        sd_now: now[(k, k)].sqrt(),
        sd_then: then[(k, k)].sqrt(),
    });
    let mut pins: Vec<DeterminedUnknown> = pin
        .filter(|pin| pin.sd_then <= PINNED * pin.sd_now)
        .collect();
    pins.sort_by(|a, b| (a.sd_then / a.sd_now).total_cmp(&(b.sd_then / b.sd_now)));
    FurtherMeasurement { measurement, pins }
}
