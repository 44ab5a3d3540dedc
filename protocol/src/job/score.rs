//! A simulation compared with its gauge record.
use super::verdict::{Counters, Verdict};
use serde::{Deserialize, Serialize};

/// What scoring found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// How the simulation ended.
    pub verdict: Verdict,
    /// The objective [MPa^2] for a complete run; a graded value above every complete run's
    /// otherwise.
    pub fitness: f64,
    /// One entry per gauge of the record; empty unless complete.
    pub channels: Vec<ChannelScore>,
    /// Measured minus simulated stress after offset removal \[MPa\], gauges of the objective one
    /// after the other on the output grid, each scaled such that the squared length of the whole is
    /// the objective; empty unless asked for and complete.
    pub residual_mpa: Vec<f64>,
    /// What it cost.
    pub counters: Counters,
}

/// Agreement of one gauge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChannelScore {
    /// Gauge number.
    pub gauge: u8,
    /// Mean squared error as the objective treats the offset [MPa^2].
    pub mse_mpa2: f64,
    /// Mean squared error of absolute values [MPa^2].
    pub mse_fixed_offset_mpa2: f64,
    /// Measured minus simulated mean \[MPa\].
    pub offset_mpa: f64,
    /// Root mean squared error over half the measured range \[1\].
    pub rmse_over_half_range: f64,
    /// Mean absolute error over the mean absolute deviation of the measured curve from its mean
    /// \[1\].
    pub relative_error: f64,
    /// Simulated minus measured peak-to-peak stress, over the measured one \[1\].
    pub peak_to_peak_error: f64,
}
