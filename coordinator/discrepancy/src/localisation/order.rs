//! Map of a residual by channel and order of the period: coefficients that are larger than noise.
//!
//! The squared modulus of a whitened coefficient, over its mean under noise, follows F(2, 2 nu); the rule of
//! Benjamini and Hochberg keeps the share of false entries below a set level.
use crate::linear::tangent::Tangent;
use crate::localisation::residual::Residual;
use nalgebra::{Complex, DVector};
use record::metric::Metric;
use record::spectrum::Spectra;
use search::random::{Phase, Streams};
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF as _, FisherSnedecor};

/// Channel and order of the period at which the residual exceeds noise significantly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Peak {
    /// Index of the channel in the record.
    pub channel: usize,
    /// Order of the period (harmonic number).
    pub order: usize,
    /// Squared modulus of the whitened Fourier coefficient over its mean under noise.
    pub ratio: f64,
    /// Tail probability of the power ratio under noise, not corrected for the number of channels and orders.
    pub p_value: f64,
}

/// Map of the residual's power by channel and order of the period, with the significant peaks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrderMap {
    /// Squared modulus of each whitened Fourier coefficient over its mean under noise, by channel and order.
    pub ratio: Vec<Vec<f64>>,
    /// Significant peaks of the map, the strongest first.
    pub peaks: Vec<Peak>,
}

/// Builds the map of orders of a whitened residual. `freedom` is the number of degrees of freedom of the
/// noise variances, `level` the allowed share of false peaks. A channel without a period has no orders.
pub fn map(residual: &Residual<'_>, freedom: f64, level: f64) -> OrderMap {
    let bins = residual.metric.bins();
    let mut ratio = vec![Vec::new(); bins.len()];
    if bins.iter().any(|bins| bins.is_periodic) {
        let powers = powers(residual).into_iter().zip(&bins);
        ratio = powers
            .map(|(row, bins)| if bins.is_periodic { row } else { Vec::new() })
            .collect();
    }
    // variances without doubt are like very many degrees of freedom
    let law = FisherSnedecor::new(2.0, freedom.clamp(2.0, 1e6));
    let tail = |x: f64| law.as_ref().map_or(1.0, |law| law.sf(x));
    let mut entries: Vec<Peak> = Vec::new();
    for (channel, row) in ratio.iter().enumerate() {
        entries.extend(row.iter().enumerate().map(|(k, &ratio)| Peak {
            channel,
            order: k + 1,
            ratio,
            p_value: tail(ratio),
        }));
    }
    entries.sort_by(|a, b| {
        a.p_value
            .total_cmp(&b.p_value)
            .then(b.ratio.total_cmp(&a.ratio))
    });
    let tests = entries.len() as f64;
    let last = entries
        .iter()
        .enumerate()
        .filter(|(i, peak)| peak.p_value <= level * (i + 1) as f64 / tests)
        .map(|(i, _)| i + 1)
        .next_back();
    entries.truncate(last.unwrap_or(0));
    OrderMap {
        ratio,
        peaks: entries,
    }
}

/// Returns the power of each wave (order of the period, or Fourier coefficient over samples) of a whitened
/// residual over its mean under noise, by channel, lowest wave first.
pub fn powers(residual: &Residual<'_>) -> Vec<Vec<f64>> {
    let Residual {
        values: left,
        metric,
        tangent,
    } = *residual;
    let waves = metric.waves(left).into_iter();
    let channels = waves.zip(expectation(metric, tangent));
    let ratio = |(wave, expected): (&Complex<f64>, &f64)| wave.norm_sqr() / expected.max(1e-3);
    channels
        .map(|(waves, expected)| waves.iter().zip(&expected).map(ratio).collect())
        .collect()
}

/// Estimates, by sampling, the mean power that each wave of noise has after projection off the tangent space.
fn expectation(metric: &Metric, tangent: &Tangent) -> Vec<Vec<f64>> {
    const DRAWS: usize = 64;
    let streams = Streams::new(0x6f72_6465, 0);
    let mut sums: Spectra = Vec::new();
    for draw in 0..DRAWS {
        let mut stream = streams.at(0, Phase::Resample, draw);
        let z = DVector::from_fn(metric.len(), |_, _| stream.normal());
        // 1 - (share that the projection takes): less noisy than the power itself
        let lost = &z - tangent.project(&z);
        let (drawn, lost) = (metric.waves(&z), metric.waves(&lost));
        sums.resize_with(drawn.len(), Vec::new);
        for ((sum, drawn), lost) in sums.iter_mut().zip(&drawn).zip(&lost) {
            sum.resize(drawn.len(), Complex::new(0.0, 0.0));
            for ((sum, z), lost) in sum.iter_mut().zip(drawn).zip(lost) {
                sum.re += 2.0 * z.re * lost.re - lost.re * lost.re;
                sum.im += 2.0 * z.im * lost.im - lost.im * lost.im;
            }
        }
    }
    let left = |sum: &Complex<f64>| (2.0 - (sum.re + sum.im) / DRAWS as f64).clamp(0.2, 2.0);
    sums.iter()
        .map(|sum| sum.iter().map(left).collect())
        .collect()
}
