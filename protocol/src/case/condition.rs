//! Working conditions and the gauge record that belongs to them.
use serde::{Deserialize, Serialize};

/// One working condition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Condition {
    /// Short name, as `5rpm`.
    pub name: String,
    /// Measured stress; absent where a condition is only simulated.
    pub record: Option<GaugeRecord>,
}

/// Measured stress on the output grid, averaged over cycles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GaugeRecord {
    /// Crank angle from bottom dead centre: the output grid \[deg\].
    pub turn_deg: Vec<f64>,
    /// Number of whole cycles that were averaged.
    pub cycles: usize,
    /// One entry per gauge of the record.
    pub gauges: Vec<GaugeTrace>,
}

/// The averaged record of one gauge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GaugeTrace {
    /// Gauge number, 1 to 4.
    pub gauge: u8,
    /// Mean over cycles \[MPa\].
    pub mean_mpa: Vec<f64>,
    /// Standard deviation between cycles \[MPa\]; zeros where there is one cycle only.
    pub spread_mpa: Vec<f64>,
}
