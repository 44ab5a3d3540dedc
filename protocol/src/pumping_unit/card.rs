//! Load at the suspension point over one crank revolution.
use serde::{Deserialize, Serialize};

/// Load at the suspension point over one crank revolution, periodic.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoadCard {
    /// Crank angle from bottom dead centre, equally spaced from 0, without 360 \[deg\].
    pub turn_deg: Vec<f64>,
    /// Load, positive downwards \[N\]; one value per crank angle.
    pub load_n: Vec<f64>,
    /// Smoothing applied to the card before use.
    pub smoothing: Smoothing,
}

/// Smoothing of a load card.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Smoothing {
    /// No smoothing: the card is used as delivered.
    None,
    /// Only this many harmonics of the crank are kept.
    Harmonics(u32),
    /// Centred moving average over this many degrees of crank angle.
    MovingAverageDeg(f64),
}
