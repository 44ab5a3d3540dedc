//! Comparison of a simulation with the measured records.
use super::derivative::Derivative;
use super::verdict::{Counters, Verdict};
use serde::{Deserialize, Serialize};

/// Result of scoring an individual.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// Verdict: whether the simulation was completed or how the simulated machine failed.
    pub verdict: Verdict,
    /// Objective of a complete simulation; otherwise a graded penalty above the objective of every complete
    /// one.
    pub fitness: f64,
    /// Agreement of each measured channel of the condition; empty unless the simulation is complete.
    pub channels: Vec<ChannelScore>,
    /// Residual: measured minus simulated curves after removal of offsets, the objective's channels one after
    /// the other, each scaled such that the squared norm of the whole vector is the objective; empty unless
    /// requested and the run is complete.
    pub residual: Vec<f64>,
    /// Derivatives of the residual with respect to the requested parameters, in the order of the request, one
    /// curve each; empty if the residual is.
    pub columns: Vec<Derivative>,
    /// Work counters of the simulation (steps, iterations).
    pub counters: Counters,
}

/// Agreement of simulation and measured record in one channel, in the channel's unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChannelScore {
    /// Index of the channel in the case.
    pub channel: usize,
    /// Mean squared error of the channel, with a constant difference treated as in the objective \[unit^2\].
    pub mse: f64,
    /// Mean squared error of the channel without removal of a constant difference \[unit^2\].
    pub mse_fixed_offset: f64,
    /// Mean of the measured curve minus mean of the simulated one \[unit\].
    pub offset: f64,
    /// Root mean squared error divided by half the measured range \[1\].
    pub rmse_over_half_range: f64,
    /// Mean absolute error divided by the mean absolute deviation of the measured curve from its mean \[1\].
    pub relative_error: f64,
    /// Peak-to-peak range of the simulated curve minus that of the measured one, divided by the latter \[1\].
    pub peak_to_peak_error: f64,
}
