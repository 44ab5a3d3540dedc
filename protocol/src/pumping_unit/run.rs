//! Settings of start, sampling and time integration of a simulated run.
use serde::{Deserialize, Serialize};

/// Settings of start, sampling and time integration of a simulated run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunSettings {
    /// Spacing of the output samples in crank angle \[deg\]; divides 360.
    pub output_step_deg: f64,
    /// Crank angle simulated before the recorded revolution \[deg\].
    pub lead_in_deg: f64,
    /// Time in which the crank accelerates from rest to full speed \[s\].
    pub ramp_s: f64,
    /// Time integration method.
    pub integrator: Integrator,
    /// Largest time step where the beam oscillates slowly on its ropes \[s\]; stiffer ropes get
    /// proportionally shorter steps. It limits how coarsely the ropes' own modes are resolved.
    pub longest_step_s: f64,
    /// Tolerance of the integrator, relative to its built-in error scales.
    pub tolerance: f64,
    /// Number of modes of the back head that are simulated.
    pub modes: usize,
    /// Number of Newton iterations after which a simulation is ended as failed.
    #[serde(default = "iterations")]
    pub iteration_budget: u64,
}

const fn iterations() -> u64 {
    25_000
}

/// Time integration method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// TR-BDF2: second order, two implicit stages per step.
    TrBdf2,
    /// ESDIRK: fourth order, five implicit stages per step.
    Esdirk4,
}

impl Integrator {
    /// All time integration methods.
    pub const ALL: [Self; 2] = [Self::TrBdf2, Self::Esdirk4];

    /// Returns the name of the integration method used in case files.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::TrBdf2 => "tr_bdf2",
            Self::Esdirk4 => "esdirk4",
        }
    }
}
