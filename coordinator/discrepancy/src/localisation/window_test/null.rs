//! Null distribution of the largest window mean: from the record's own cycles with signs flipped, or from
//! noise drawn from the metric.
use crate::linear::tangent::Tangent;
use crate::localisation::window_test::windows::{WIDTHS, Windows, windows};
use nalgebra::DVector;
use record::metric::Metric;
use search::random::{Phase, Streams};

/// Returns whether sign flips of `cycles` cycles give at least `1 / alpha` different sets; the first cycle
/// keeps its sign.
pub(crate) fn can_flip(cycles: usize, alpha: f64) -> bool {
    cycles >= 2 && alpha * libm::exp2(cycles as f64 - 1.0) >= 1.0
}

/// Null distribution of the largest window mean of a record.
pub(crate) struct Null {
    /// Standard deviation of a window mean by channel and width.
    pub(crate) scales: Vec<Vec<f64>>,
    /// Largest scaled window mean of each noise set, in ascending order.
    maxima: Vec<f64>,
    /// Whether all sign combinations were enumerated, so that the measured record itself is among the noise
    /// records.
    complete: bool,
}

impl Null {
    /// Builds the distribution from window means of the cycles, whose signs are flipped in up to `draws`
    /// combinations.
    pub(crate) fn flipped(cycles: &[Windows], draws: usize) -> Self {
        let n = cycles.len();
        let square = |c: usize, w: usize| -> f64 {
            let of = |cycle: &Windows| cycle[c][w].iter().map(|x| x * x).sum::<f64>();
            cycles.iter().map(of).sum::<f64>() / cycles[0][c][w].len() as f64
        };
        let scale = |c: usize, w: usize| (square(c, w).sqrt() / n as f64).max(f64::MIN_POSITIVE);
        let scales: Vec<Vec<f64>> = (0..cycles[0].len())
            .map(|c| (0..WIDTHS.len()).map(|w| scale(c, w)).collect())
            .collect();
        let all = u32::try_from(n - 1)
            .ok()
            .and_then(|n| 1_usize.checked_shl(n));
        let complete = all.is_some_and(|all| all <= draws);
        let streams = Streams::new(0x666c_6970, 0);
        let sets = if complete {
            all.unwrap_or(draws)
        } else {
            draws
        };
        let signs = |set: usize| -> Vec<f64> {
            let mut stream = streams.at(0, Phase::Resample, set);
            let sign = |k: usize| {
                let minus = if complete {
                    k > 0 && set >> (k - 1) & 1 == 1
                } else {
                    stream.chance(0.5)
                };
                if minus { -1.0 } else { 1.0 }
            };
            (0..n).map(sign).collect()
        };
        let maxima = (0..sets).map(|set| {
            let signs = signs(set);
            let mean = |c: usize, w: usize, b: usize| {
                let parts = cycles
                    .iter()
                    .zip(&signs)
                    .map(|(cycle, sign)| sign * cycle[c][w][b]);
                parts.sum::<f64>() / n as f64
            };
            largest(&cycles[0], &scales, mean)
        });
        let maxima = maxima.collect();
        Self::new(maxima, scales, complete)
    }

    /// Builds the distribution from `draws` noise sets drawn from the metric and projected like the residual.
    pub(crate) fn drawn(metric: &Metric, tangent: &Tangent, draws: usize) -> Self {
        let streams = Streams::new(0x616e_676c, 0);
        let noise: Vec<Windows> = (0..draws)
            .map(|draw| {
                let mut stream = streams.at(0, Phase::Resample, draw);
                let z = DVector::from_fn(metric.len(), |_, _| stream.normal());
                windows(&tangent.project(&z), metric)
            })
            .collect();
        let scale = |c: usize, w: usize| -> f64 {
            let of = |set: &Windows| set[c][w].iter().map(|x| x * x).sum::<f64>();
            let sum: f64 = noise.iter().map(of).sum();
            let count = noise.first().map_or(0, |set| draws * set[c][w].len());
            (sum / count as f64).sqrt().max(f64::MIN_POSITIVE)
        };
        let scales: Vec<Vec<f64>> = (0..metric.channels())
            .map(|c| (0..WIDTHS.len()).map(|w| scale(c, w)).collect())
            .collect();
        let maxima = noise
            .iter()
            .map(|set| largest(set, &scales, |c, w, b| set[c][w][b]));
        let maxima = maxima.collect();
        Self::new(maxima, scales, false)
    }

    fn new(mut maxima: Vec<f64>, scales: Vec<Vec<f64>>, complete: bool) -> Self {
        maxima.sort_by(f64::total_cmp);
        Self {
            scales,
            maxima,
            complete,
        }
    }

    /// Returns the share of noise sets with a window at least as strong.
    pub(crate) fn p_value(&self, strength: f64) -> f64 {
        // the record's own set has exactly its strongest window, up to rounding
        let below = self
            .maxima
            .partition_point(|m| *m < strength.abs() * (1.0 - 1e-9));
        let (above, sets) = (self.maxima.len() - below, self.maxima.len());
        if self.complete {
            above as f64 / sets as f64
        } else {
            (1 + above) as f64 / (1 + sets) as f64
        }
    }
}

/// Returns the largest absolute scaled window mean over all channels, widths and bins; `value` gives a mean,
/// `like` the shape.
fn largest(like: &Windows, scales: &[Vec<f64>], value: impl Fn(usize, usize, usize) -> f64) -> f64 {
    let mut most: f64 = 0.0;
    for (c, scales) in scales.iter().enumerate() {
        for (w, scale) in scales.iter().enumerate() {
            for b in 0..like[c][w].len() {
                most = most.max((value(c, w, b) / scale).abs());
            }
        }
    }
    most
}
