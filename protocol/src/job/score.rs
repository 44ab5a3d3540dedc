//! A simulation compared with what was measured.
use super::derivative::Derivative;
use super::verdict::{Counters, Verdict};
use serde::{Deserialize, Serialize};

/// What scoring found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// How the simulation ended.
    pub verdict: Verdict,
    /// The objective for a complete run; a graded value above every complete run's otherwise.
    pub fitness: f64,
    /// One entry per measured channel of the condition; empty unless complete.
    pub channels: Vec<ChannelScore>,
    /// Measured minus simulated curves after offset removal, channels of the objective one after the
    /// other, each scaled such that the squared length of the whole is the objective; empty unless
    /// asked for and complete.
    pub residual: Vec<f64>,
    /// Derivatives of the residual by the columns that were asked for, in their order, one curve each;
    /// empty where the residual is.
    pub columns: Vec<Derivative>,
    /// What it cost.
    pub counters: Counters,
}

/// Agreement of one channel, in the channel's unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChannelScore {
    /// Index of the channel in the case.
    pub channel: usize,
    /// Mean squared error as the objective treats the offset \[unit^2\].
    pub mse: f64,
    /// Mean squared error of absolute values \[unit^2\].
    pub mse_fixed_offset: f64,
    /// Measured minus simulated mean \[unit\].
    pub offset: f64,
    /// Root mean squared error over half the measured range \[1\].
    pub rmse_over_half_range: f64,
    /// Mean absolute error over the mean absolute deviation of the measured curve from its mean
    /// \[1\].
    pub relative_error: f64,
    /// Simulated minus measured range from lowest to highest, over the measured one \[1\].
    pub peak_to_peak_error: f64,
}
