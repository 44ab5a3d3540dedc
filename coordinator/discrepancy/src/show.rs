//! The gap that is left, with its interval: on the cycles that were fitted, on those that were not,
//! and under a condition that took no part.
//!
//! By channel `g = (MSE - se^2) / var`, both curves without their means; over the gauges the mean.
//! `closed = 1 - g_after / g_before`; intervals by resampling the cycles, before and after on the
//! same resample. A gap that closes does not prove a name: a wrong effect often closes most of it,
//! which is why the best rejected rival is always shown beside.
use crate::record::{Curves, Record, Source, mean_of, variance};
use search::random::{Phase, Streams};

/// The gap before and after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closed {
    /// Gap of the recalibrated model without the effect.
    pub before: f64,
    /// Gap with it.
    pub after: f64,
    /// `1 - after / before`.
    pub closed: f64,
    /// 95 % interval of `closed`; none with fewer than two cycles.
    pub interval: Option<[f64; 2]>,
}

/// The gap over the gauges of a record; the mean of the channels' gaps, not below 0.
pub fn gap(record: &Record, simulated: &Curves) -> f64 {
    gap_of(record, &record.cycles.iter().collect::<Vec<_>>(), simulated)
}

/// Before and after, with the interval.
pub fn closed(record: &Record, before: &Curves, after: &Curves) -> Closed {
    const DRAWS: usize = 1000;
    let all: Vec<&Curves> = record.cycles.iter().collect();
    let ratio = |before: f64, after: f64| {
        if before > 0.0 {
            1.0 - after / before
        } else {
            0.0
        }
    };
    let [b, a] = [before, after].map(|curves| gap_of(record, &all, curves));
    let interval = (all.len() >= 2).then(|| {
        let streams = Streams::new(0x7368_6f77, 0);
        let mut draws: Vec<f64> = (0..DRAWS)
            .map(|draw| {
                let mut stream = streams.at(0, Phase::Resample, draw);
                let drawn: Vec<&Curves> = (0..all.len())
                    .map(|_| all[stream.index(all.len())])
                    .collect();
                // the noise is that of the whole record: a resample's own is biased by its copies
                let [b, a] = [before, after]
                    .map(|curves| (mse(record, &drawn, curves) - noise(record)).max(0.0));
                ratio(b, a)
            })
            .collect();
        draws.sort_by(f64::total_cmp);
        [draws[DRAWS / 40], draws[DRAWS - 1 - DRAWS / 40]]
    });
    Closed {
        before: b,
        after: a,
        closed: ratio(b, a),
        interval,
    }
}

fn gap_of(record: &Record, cycles: &[&Curves], simulated: &Curves) -> f64 {
    (mse(record, cycles, simulated) - noise(record)).max(0.0)
}

/// Gauges of a record; every channel where it has none.
fn gauges(record: &Record) -> Vec<usize> {
    let is_gauge = |c: &usize| matches!(record.channels[*c], Source::Gauge(_));
    let gauges: Vec<usize> = (0..record.channels.len()).filter(is_gauge).collect();
    if gauges.is_empty() {
        (0..record.channels.len()).collect()
    } else {
        gauges
    }
}

/// Mean over the gauges of the squared residual over the record's variance.
fn mse(record: &Record, cycles: &[&Curves], simulated: &Curves) -> f64 {
    let mean = mean_of(cycles);
    let whole = record.mean();
    let gauges = gauges(record);
    let each = gauges.iter().map(|&c| {
        let residual: Vec<f64> = mean[c]
            .iter()
            .zip(&simulated[c])
            .map(|(y, s)| y - s)
            .collect();
        variance(&residual) / variance(&whole[c]).max(f64::MIN_POSITIVE)
    });
    each.sum::<f64>() / gauges.len().max(1) as f64
}

/// What the scatter between cycles explains of it.
fn noise(record: &Record) -> f64 {
    let whole = record.mean();
    let gauges = gauges(record);
    let scatter = record.cycle_variance();
    let cycles = record.cycles.len().max(1) as f64;
    let each = gauges
        .iter()
        .map(|&c| scatter[c] / cycles / variance(&whole[c]).max(f64::MIN_POSITIVE));
    each.sum::<f64>() / gauges.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Stated;
    use search::random::Streams;

    fn wave(amplitude: f64, phase: f64) -> Vec<f64> {
        (0..720)
            .map(|i| amplitude * (f64::from(i) * 0.5_f64.to_radians() + phase).sin())
            .collect()
    }

    fn record(truth: &[f64], noise: f64, cycles: usize) -> Record {
        let streams = Streams::new(9, 0);
        let cycles = (0..cycles).map(|k| {
            let mut stream = streams.at(0, Phase::Resample, k);
            vec![truth.iter().map(|y| y + noise * stream.normal()).collect()]
        });
        Record {
            condition: 0,
            channels: vec![Source::Gauge(1)],
            cycles: cycles.collect(),
            stated: Stated::default(),
        }
    }

    #[test]
    fn the_right_curve_closes_the_gap_and_the_interval_says_so() {
        let truth = wave(10.0, 0.0);
        let record = record(&truth, 0.3, 8);
        let off: Vec<f64> = truth
            .iter()
            .zip(wave(1.0, 1.0))
            .map(|(a, b)| a + b + 5.0)
            .collect();
        let shown = closed(&record, &vec![off.clone()], &vec![truth]);
        assert!((shown.before - 0.01).abs() < 1e-3, "{shown:?}");
        assert!(shown.closed > 0.98, "{shown:?}");
        let [low, high] = shown.interval.unwrap();
        assert!(low > 0.9 && high <= 1.0 && low <= shown.closed, "{shown:?}");
        let same = closed(&record, &vec![off.clone()], &vec![off]);
        assert!(same.closed.abs() < 1e-12);
        // a single held-out cycle takes its noise from the others
        let (_, held) = record.split();
        let one = held.part(0..1);
        assert!(gap(&one, &vec![wave(10.0, 0.0)]) < 3e-4);
        assert!(mse(&one, &[&one.cycles[0]], &vec![wave(10.0, 0.0)]) > 1.5e-3);
        assert!(
            closed(
                &record.part(0..1),
                &vec![wave(1.0, 0.0)],
                &vec![wave(2.0, 0.0)]
            )
            .interval
            .is_none()
        );
    }
}
