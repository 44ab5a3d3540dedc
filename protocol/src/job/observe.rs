//! Simulate and return the measured channels alone: what a diagnosis needs of a run.
use super::{Counters, Verdict};
use crate::case::EffectSetting;
use serde::{Deserialize, Serialize};

/// What to simulate, and how finely.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ObserveSpec {
    /// Index of the condition in the case.
    pub condition: usize,
    /// Gene values in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// Effects beside those of the case; the same identifier replaces the case's.
    pub effects: Vec<EffectSetting>,
    /// What is discretised otherwise than in the case.
    pub refinement: Refinement,
}

/// Another discretisation of the same machine; what is absent stays as the case has it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Refinement {
    /// Length of a rope cylinder \[m\]; both ropes keep their lengths, which it must divide.
    pub cylinder_length_m: Option<f64>,
    /// Crank angle that is run before the recorded revolution \[deg\].
    pub lead_in_deg: Option<f64>,
    /// Number of head modes.
    pub modes: Option<usize>,
    /// Longest step \[s\].
    pub longest_step_s: Option<f64>,
    /// Tolerance of the integrator, relative to its built-in error scales.
    pub tolerance: Option<f64>,
}

/// The channels of one revolution; every vector has one entry per crank angle reached.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Observation {
    /// How it ended.
    pub verdict: Verdict,
    /// What it cost.
    pub counters: Counters,
    /// Stress at gauges 1 to 4 \[MPa\].
    pub gauge_mpa: [Vec<f64>; 4],
    /// Suspension height above its lowest design position \[m\].
    pub suspension_m: Vec<f64>,
    /// Net torque at the crank shaft, counterweight included [N m].
    pub crank_torque_n_m: Vec<f64>,
}
