//! Share of the gap that an effect closes, with its interval: on the cycles that were fitted, on held-out
//! cycles, and under a condition that took no part.
//!
//! By channel `g = (MSE - se^2) / var`, both curves without their means; the gap is the mean over the scored
//! channels. `closed = 1 - g_after / g_before`. Intervals come from a bootstrap of cycles, with the same
//! resample before and after; the cycles are the record's own, or those of a record that holds more of the
//! same kind. A gap that closes does not prove an effect: a wrong effect often closes most of it, which is
//! why the best rejected rival is always shown beside it.
use record::{Curves, Record, mean_of, power, scatter};
use search::random::{Phase, Stream, Streams};
use serde::{Deserialize, Serialize};

/// Gap before and after an effect is added.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Closed {
    /// Gap of the recalibrated model without the effect.
    pub before: f64,
    /// Gap of the recalibrated model with the effect.
    pub after: f64,
    /// Share of the gap that is closed: `1 - after / before`.
    pub closed: f64,
    /// 95 % interval of the closed share; `None` where fewer than two cycles are available.
    #[serde(rename = "ci95")]
    pub interval: Option<[f64; 2]>,
}

/// Returns the gap over the scored channels of a record: the mean of the channels' gaps, not below 0.
pub fn gap(record: &Record, simulated: &Curves) -> f64 {
    GapReference::new(record).gap(simulated)
}

/// Computes the gap before and after an effect is added, with the interval of the closed share. `alike` are
/// cycles of the same channels and condition with the same scatter, including the record's own.
///
/// A mean of resampled cycles scatters about the record's mean as that mean does about the truth, so its
/// squared residual holds the scatter twice: the second part is subtracted too, so that the bootstrap draws
/// lie about the reported gap.
pub fn gap_closure(record: &Record, alike: &[Curves], before: &Curves, after: &Curves) -> Closed {
    const DRAWS: usize = 1000;
    // where noise explains all that there was, all is closed or nothing
    let ratio = |[before, after]: [f64; 2]| {
        if before > 0.0 {
            1.0 - after.max(0.0) / before
        } else if after < before {
            1.0
        } else {
            0.0
        }
    };
    let ruler = GapReference::new(record);
    let gaps = [before, after].map(|curves| ruler.gap(curves));
    let pool = Bootstrap::new(alike);
    let interval = pool.map(|pool| {
        // that of the cycles that are drawn, whatever else tells the record's noise
        let noise = ruler.noise + ruler.explained_by(&scatter(alike));
        let streams = Streams::new(0x7368_6f77, 0);
        let mut draws: Vec<f64> = (0..DRAWS)
            .map(|draw| {
                let stream = &mut streams.at(0, Phase::Resample, draw);
                let drawn = pool.drawn(record.cycles.len(), &ruler.mean, stream);
                let left = |curves| ruler.mse(&drawn, curves) - noise;
                ratio([before, after].map(left))
            })
            .collect();
        draws.sort_by(f64::total_cmp);
        [draws[DRAWS / 40], draws[DRAWS - 1 - DRAWS / 40]]
    });
    Closed {
        before: gaps[0],
        after: gaps[1],
        closed: ratio(gaps),
        interval,
    }
}

/// Cycles from which a bootstrap resamples, at least two.
struct Bootstrap<'a> {
    cycles: &'a [Curves],
    mean: Curves,
}

impl<'a> Bootstrap<'a> {
    fn new(cycles: &'a [Curves]) -> Option<Self> {
        (cycles.len() >= 2).then(|| Self {
            cycles,
            mean: mean_of(&cycles.iter().collect::<Vec<_>>()),
        })
    }

    /// Returns the mean of `count` cycles drawn with replacement; its deviation from the pool's mean is
    /// stretched by `sqrt(n / (n - 1))`, since cycles scatter less about their own mean than about the truth,
    /// and applied to the mean `about`.
    fn drawn(&self, count: usize, about: &Curves, stream: &mut Stream) -> Curves {
        let n = self.cycles.len();
        let drawn: Vec<&Curves> = (0..count).map(|_| &self.cycles[stream.index(n)]).collect();
        let stretch = (n as f64 / (n as f64 - 1.0)).sqrt();
        let mut drawn = mean_of(&drawn);
        for ((drawn, mean), about) in drawn.iter_mut().zip(&self.mean).zip(about) {
            for ((y, mean), about) in drawn.iter_mut().zip(mean).zip(about) {
                *y = about + stretch * (*y - mean);
            }
        }
        drawn
    }
}

/// Reference for computing gaps of simulated curves: the mean of a record's channels, with their variances.
struct GapReference {
    /// Number of cycles of the record.
    cycles: f64,
    mean: Curves,
    /// Indices of the channels on which the gap is counted, with their variances.
    channels: Vec<(usize, f64)>,
    /// Whether the mean of a residual counts in the gap, by channel: true for channels with a fixed zero.
    absolute: Vec<bool>,
    /// Mean squared residual, over the measured variance, that the scatter between cycles alone explains.
    noise: f64,
}

impl GapReference {
    fn new(record: &Record) -> Self {
        let mean = record.mean();
        let absolute: Vec<bool> = record
            .channels
            .iter()
            .map(|own| own.channel.is_absolute())
            .collect();
        let channel = |c: usize| (c, power(&mean[c], absolute[c]).max(f64::MIN_POSITIVE));
        let mut ruler = Self {
            cycles: record.cycles.len().max(1) as f64,
            channels: record.scored().into_iter().map(channel).collect(),
            mean,
            absolute,
            noise: 0.0,
        };
        ruler.noise = ruler.explained_by(&record.cycle_variance());
        ruler
    }

    fn gap(&self, simulated: &Curves) -> f64 {
        (self.mse(&self.mean, simulated) - self.noise).max(0.0)
    }

    /// Returns the mean squared residual of `mean` less `simulated`, each divided by the measured variance
    /// and averaged over the channels.
    fn mse(&self, mean: &Curves, simulated: &Curves) -> f64 {
        let each = self.channels.iter().map(|&(c, whole)| {
            let pairs = mean[c].iter().zip(&simulated[c]);
            let residual: Vec<f64> = pairs.map(|(y, s)| y - s).collect();
            power(&residual, self.absolute[c]) / whole
        });
        each.sum::<f64>() / self.channels.len().max(1) as f64
    }

    /// Returns the part of the mean squared residual that scatter of the cycles explains; `scatter` is the
    /// variance of single cycles, by channel.
    fn explained_by(&self, scatter: &[f64]) -> f64 {
        let each = self.channels.iter();
        let each = each.map(|&(c, whole)| scatter[c] / self.cycles / whole);
        each.sum::<f64>() / self.channels.len().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::{Stated, recorded};

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
            channels: vec![recorded(0)],
            cycles: cycles.collect(),
            held_out: false,
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
        let shown = gap_closure(&record, &record.cycles, &vec![off.clone()], &vec![truth]);
        assert!((shown.before - 0.01).abs() < 1e-3, "{shown:?}");
        assert!(shown.closed > 0.98, "{shown:?}");
        let [low, high] = shown.interval.unwrap();
        assert!(low > 0.9 && high <= 1.0 && low <= shown.closed, "{shown:?}");
        let same = gap_closure(&record, &record.cycles, &vec![off.clone()], &vec![off]);
        assert!(same.closed.abs() < 1e-12);
        // a single held-out cycle takes its noise from the others
        let one = record.split().cycles.part(0..1);
        assert!(gap(&one, &vec![wave(10.0, 0.0)]) < 3e-4);
        let ruler = GapReference::new(&one);
        assert!(ruler.mse(&one.cycles[0], &vec![wave(10.0, 0.0)]) > 1.5e-3);
        assert!(
            gap_closure(
                &record.part(0..1),
                &record.cycles[..1],
                &vec![wave(1.0, 0.0)],
                &vec![wave(2.0, 0.0)]
            )
            .interval
            .is_none()
        );
    }

    /// Creates a record of one turn with white noise and a load that differs from cycle to cycle.
    fn scattered(seed: u64, truth: &[f64], cycles: usize) -> Record {
        let cycle = |k: usize| {
            let mut stream = Streams::new(seed, 5).at(0, Phase::Initial, k);
            let load = 1.0 + 0.004 * stream.normal();
            let noisy = truth.iter().map(|y| load * y + 0.4 * stream.normal());
            vec![noisy.collect()]
        };
        Record {
            condition: 0,
            channels: vec![recorded(0)],
            cycles: (0..cycles).map(cycle).collect(),
            held_out: false,
            stated: Stated::default(),
        }
    }

    /// Checks the coverage of the interval on records whose gaps are known: a model that is right, one that
    /// leaves as much as the noise of the mean, and one that leaves much; with few and with more cycles.
    #[test]
    fn intervals_of_the_closed_share_hold_it_in_nineteen_of_twenty() {
        let sparse = |curve: Vec<f64>| -> Vec<f64> { curve.into_iter().step_by(5).collect() };
        let off = |size: f64| -> Vec<f64> {
            let (truth, other) = (wave(10.0, 0.0), wave(size, 1.0));
            sparse(truth.iter().zip(other).map(|(a, b)| a + b).collect())
        };
        let truth = sparse(wave(10.0, 0.0));
        for cycles in [4, 8] {
            for size in [0.0, 0.2, 0.8] {
                let sets = 200;
                let expected = 1.0 - size * size / (2.0 * 2.0);
                let mut held = 0;
                for seed in 0..sets {
                    let record = scattered(seed, &truth, cycles);
                    let shown =
                        gap_closure(&record, &record.cycles, &vec![off(2.0)], &vec![off(size)]);
                    let [low, high] = shown.interval.unwrap();
                    assert!(low <= shown.closed && shown.closed <= high, "{shown:?}");
                    held += u64::from((low..=high).contains(&expected));
                }
                assert!(20 * held >= 18 * sets, "{held} of {sets}: {cycles} {size}");
            }
        }
    }
}
