//! Load at the suspension point over one crank revolution.
use serde::{Deserialize, Serialize};

/// Load at the suspension point over one crank revolution, periodic.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoadCard {
    /// Crank angle from bottom dead centre, equally spaced from 0, without 360 \[deg\].
    pub turn_deg: Vec<f64>,
    /// Load at the suspension point at each crank angle, positive downwards \[N\].
    pub load_n: Vec<f64>,
    /// Smoothing applied to the load card before use.
    pub smoothing: Smoothing,
}

/// Smoothing of a load card.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Smoothing {
    /// No smoothing: the load card is used as delivered.
    None,
    /// Smoothing that keeps only this many harmonics of the crank rotation.
    Harmonics(u32),
    /// Smoothing by a centred moving average over this many degrees of crank angle.
    MovingAverageDeg(f64),
}
