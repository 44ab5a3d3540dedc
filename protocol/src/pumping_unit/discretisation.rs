//! How space and time are divided where a job divides them otherwise than the case.
use super::Integrator;
use crate::{
    job::Numerics,
    wire::{self, WireError},
};
use serde::{Deserialize, Serialize};

/// How space and time are divided; what is absent stays as the case has it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Discretisation {
    /// Length of a rope cylinder \[m\]; both ropes keep their lengths, which it must divide.
    pub cylinder_length_m: Option<f64>,
    /// Crank angle that is run before the recorded revolution \[deg\].
    pub lead_in_deg: Option<f64>,
    /// Number of head modes.
    pub modes: Option<usize>,
    /// Method of integration.
    pub integrator: Option<Integrator>,
    /// Longest step \[s\].
    pub longest_step_s: Option<f64>,
    /// Whether the longest step stays as long on a machine that swings fast, where it would be
    /// shortened otherwise: comparisons of methods are made at the step that they name.
    pub step_as_stated: bool,
    /// Tolerance of the integrator, relative to its built-in error scales; so large a one that no
    /// step is ever rejected makes the longest step a fixed one.
    pub tolerance: Option<f64>,
    /// Newton iterations after which the run ends.
    pub budget: Option<u64>,
}

impl Discretisation {
    /// Nothing is divided otherwise than in the case.
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

    /// That of a job.
    ///
    /// # Errors
    /// [`WireError`] for bytes that say nothing of a pumping unit.
    pub fn of(numerics: &Numerics) -> Result<Self, WireError> {
        if numerics.0.is_empty() {
            return Ok(Self::OF_THE_CASE);
        }
        wire::decode(&numerics.0)
    }

    /// As a job carries it.
    ///
    /// # Errors
    /// [`WireError::TooLong`] beyond what a message may hold.
    pub fn numerics(&self) -> Result<Numerics, WireError> {
        if *self == Self::OF_THE_CASE {
            return Ok(Numerics::OF_THE_CASE);
        }
        wire::encode(self).map(Numerics)
    }
}
