//! Channel x order of the crank: coefficients of the residual that are no noise.
//!
//! The squared modulus of a whitened coefficient, over its mean under noise, follows F(2, 2 nu);
//! Benjamini and Hochberg's rule keeps the share of false entries below a set level.
use crate::metric::Metric;
use crate::tangent::Tangent;
use nalgebra::DVector;
use search::random::{Phase, Streams};
use statrs::distribution::{ContinuousCDF as _, FisherSnedecor};

/// One entry of the map that is no noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Peak {
    /// Index of the channel.
    pub channel: usize,
    /// Order of the crank.
    pub order: usize,
    /// Squared modulus over its mean under noise.
    pub ratio: f64,
    /// Tail probability of that one entry.
    pub p_value: f64,
}

/// The map.
#[derive(Clone, Debug, PartialEq)]
pub struct OrderMap {
    /// Ratio by channel and order.
    pub ratio: Vec<Vec<f64>>,
    /// Significant entries, the strongest first.
    pub peaks: Vec<Peak>,
}

/// Maps a whitened residual; `freedom` is that of the noise's variances.
pub fn map(
    residual: &DVector<f64>,
    metric: &Metric,
    tangent: &Tangent,
    freedom: f64,
    level: f64,
) -> OrderMap {
    let channels = metric.channels();
    let expected = expectation(metric, tangent);
    let highest = metric.orders().highest();
    let power = |x: &DVector<f64>, c: usize, k: usize| {
        let at = 2 * (k * channels + c);
        x[at] * x[at] + x[at + 1] * x[at + 1]
    };
    let ratio: Vec<Vec<f64>> = (0..channels)
        .map(|c| {
            (0..highest)
                .map(|k| power(residual, c, k) / expected[2 * (k * channels + c)].max(1e-3))
                .collect()
        })
        .collect();
    // variances without doubt are like very many degrees of freedom
    let law = FisherSnedecor::new(2.0, freedom.clamp(2.0, 1e6));
    let tail = |x: f64| law.as_ref().map_or(1.0, |law| law.sf(x));
    let mut entries: Vec<Peak> = ratio
        .iter()
        .enumerate()
        .flat_map(|(channel, row)| {
            row.iter()
                .enumerate()
                .map(move |(k, &ratio)| (channel, k, ratio))
        })
        .map(|(channel, k, ratio)| Peak {
            channel,
            order: k + 1,
            ratio,
            p_value: tail(ratio),
        })
        .collect();
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

/// Mean power of projected noise, by sampling, entry by entry of a whitened vector (both parts
/// together).
fn expectation(metric: &Metric, tangent: &Tangent) -> Vec<f64> {
    const DRAWS: usize = 64;
    let streams = Streams::new(0x6f72_6465, 0);
    let mut sum = vec![0.0; metric.len()];
    for draw in 0..DRAWS {
        let mut stream = streams.at(0, Phase::Resample, draw);
        let z = DVector::from_fn(metric.len(), |_, _| stream.normal());
        // 1 - (share that the projection takes): less noisy than the power itself
        let lost = &z - tangent.project(&z);
        for (at, sum) in sum.iter_mut().enumerate() {
            *sum += 2.0 * z[at] * lost[at] - lost[at] * lost[at];
        }
    }
    (0..metric.len())
        .map(|at| {
            let pair = at / 2 * 2;
            let taken = (sum[pair] + sum[pair + 1]) / DRAWS as f64;
            (2.0 - taken).clamp(0.2, 2.0)
        })
        .collect()
}
