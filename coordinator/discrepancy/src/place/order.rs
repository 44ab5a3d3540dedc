//! Channel x order of the crank: coefficients of the residual that are no noise.
//!
//! The squared modulus of a whitened coefficient, over its mean under noise, follows F(2, 2 nu);
//! Benjamini and Hochberg's rule keeps the share of false entries below a set level.
use crate::linear::tangent::Tangent;
use crate::place::residual::Residual;
use crate::record::metric::Metric;
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

/// Which orders of which channels hold more than noise.
#[derive(Clone, Debug, PartialEq)]
pub struct OrderMap {
    /// Ratio by channel and order.
    pub ratio: Vec<Vec<f64>>,
    /// Significant entries, the strongest first.
    pub peaks: Vec<Peak>,
}

/// Maps a whitened residual; `freedom` is that of the noise's variances.
pub fn map(residual: &Residual<'_>, freedom: f64, level: f64) -> OrderMap {
    let Residual {
        left,
        metric,
        tangent,
    } = *residual;
    let expected = expectation(metric, tangent);
    let own = |order: usize, channel: usize| {
        let power = metric.coefficient(left, order, channel).norm_sqr();
        power / expected[metric.entry(order, channel)].max(1e-3)
    };
    let row = |c: usize| {
        (1..=metric.orders().highest())
            .map(|order| own(order, c))
            .collect()
    };
    let ratio: Vec<Vec<f64>> = (0..metric.channels()).map(row).collect();
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
