//! What a calibration minimises: mean squared stress error over chosen gauges (paper, 5.1).
use serde::{Deserialize, Serialize};

/// Weighted sum of mean squared errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Objective {
    /// Index of the condition that is calibrated.
    pub condition: usize,
    /// Gauge numbers with their weights.
    pub gauges: Vec<(u8, f64)>,
    /// Treatment of the zero of each gauge.
    pub offset: Offset,
}

/// Treatment of a gauge's zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Offset {
    /// A strain bridge has no absolute zero: the mean difference is removed first.
    Free,
    /// Absolute values are compared.
    Fixed,
}
