//! The measured channels of a simulation: what a diagnosis needs of a run.
use super::verdict::{Counters, Verdict};
use crate::curve::rounded;
use serde::{Deserialize, Serialize};

/// The channels of one revolution; every vector has one entry per crank angle reached.
///
/// The worker rounds them before anybody uses them, to about a thousandth of the noise that a cycle
/// of a record has: what a run computes with, what its journal holds and what a report reads again
/// are the same numbers, and a diagnosis' journal has a fifth of the bytes (`crate::curve`).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Observation {
    /// How it ended.
    pub verdict: Verdict,
    /// What it cost.
    pub counters: Counters,
    /// Stress at gauges 1 to 4, in steps of 2 to the [`Self::GAUGE_EXPONENT`] \[MPa\].
    #[serde(with = "crate::curve::each")]
    pub gauge_mpa: [Vec<f64>; 4],
    /// Suspension height above its lowest design position, in steps of 2 to the
    /// [`Self::SUSPENSION_EXPONENT`] \[m\].
    #[serde(with = "crate::curve")]
    pub suspension_m: Vec<f64>,
    /// Net torque at the crank shaft, counterweight included, in steps of 2 to the
    /// [`Self::TORQUE_EXPONENT`] [N m].
    #[serde(with = "crate::curve")]
    pub crank_torque_n_m: Vec<f64>,
}

impl Observation {
    /// Steps of stress: 0.12 kPa.
    pub const GAUGE_EXPONENT: i32 = -13;
    /// Steps of height: a micrometre.
    pub const SUSPENSION_EXPONENT: i32 = -20;
    /// Steps of torque: 0.12 N m.
    pub const TORQUE_EXPONENT: i32 = -3;

    /// With its curves in whole steps.
    #[must_use]
    pub fn rounded(self) -> Self {
        Self {
            gauge_mpa: self
                .gauge_mpa
                .map(|gauge| rounded(&gauge, Self::GAUGE_EXPONENT)),
            suspension_m: rounded(&self.suspension_m, Self::SUSPENSION_EXPONENT),
            crank_torque_n_m: rounded(&self.crank_torque_n_m, Self::TORQUE_EXPONENT),
            ..self
        }
    }
}
