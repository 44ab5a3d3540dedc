//! Discretisation of space and time in a job that overrides the settings of the case.
use super::Integrator;
use crate::{
    job::Numerics,
    wire::{self, WireError},
};
use serde::{Deserialize, Serialize};

/// Discretisation of space and time for one job; absent fields keep the values of the case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Discretisation {
    /// Length of a rope cylinder \[m\]; must divide the lengths of both ropes, which do not change.
    pub cylinder_length_m: Option<f64>,
    /// Crank angle simulated before the recorded revolution \[deg\].
    pub lead_in_deg: Option<f64>,
    /// Number of modes of the back head that are simulated.
    pub modes: Option<usize>,
    /// Time integration method.
    pub integrator: Option<Integrator>,
    /// Largest time step of the integrator \[s\].
    pub longest_step_s: Option<f64>,
    /// Whether the largest step is also used on a machine whose beam oscillates fast, where the step is
    /// shortened otherwise; needed to compare methods at a stated step.
    pub step_as_stated: bool,
    /// Tolerance of the integrator, relative to its built-in error scales. A tolerance so large that no step
    /// is rejected gives a fixed step.
    pub tolerance: Option<f64>,
    /// Largest number of Newton iterations of a simulation, which ends when it is reached.
    pub budget: Option<u64>,
}

impl Discretisation {
    /// Discretisation without any override: all settings of the case apply.
    pub const OF_THE_CASE: Self = Self {
        cylinder_length_m: None,
        lead_in_deg: None,
        modes: None,
        integrator: None,
        longest_step_s: None,
        step_as_stated: false,
        tolerance: None,
        budget: None,
    };

    /// Decodes the discretisation of a job.
    ///
    /// # Errors
    /// [`WireError`] if the bytes are not the settings of a pumping unit.
    pub fn of(numerics: &Numerics) -> Result<Self, WireError> {
        if numerics.0.is_empty() {
            return Ok(Self::OF_THE_CASE);
        }
        wire::decode(&numerics.0)
    }

    /// Encodes the discretisation for a job.
    ///
    /// # Errors
    /// [`WireError::TooLong`] beyond the size limit of a message.
    pub fn numerics(&self) -> Result<Numerics, WireError> {
        if *self == Self::OF_THE_CASE {
            return Ok(Numerics::FROM_CASE);
        }
        wire::encode(self).map(Numerics)
    }
}
