//! What to simulate, how finely, and what to say of it: the one job of all simulations.
use crate::case::{EffectSetting, Integrator};
use serde::{Deserialize, Serialize};

/// A simulation of one revolution.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulateSpec {
    /// Of what.
    pub individual: Individual,
    /// How finely.
    pub discretisation: Discretisation,
    /// What is wanted of it.
    pub reply: Reply,
}

impl SimulateSpec {
    /// A simulation that is discretised as the case says.
    pub const fn new(individual: Individual, reply: Reply) -> Self {
        Self {
            individual,
            discretisation: Discretisation::OF_THE_CASE,
            reply,
        }
    }
}

/// A machine under a condition: values of the genes, and effects beside those of the case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Individual {
    /// Index of the condition in the case.
    pub condition: usize,
    /// Gene values in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// Effects beside those of the case; the same identifier replaces the case's.
    pub effects: Vec<EffectSetting>,
}

impl Individual {
    /// With the effects of the case alone.
    pub const fn new(condition: usize, genes: Vec<f64>) -> Self {
        Self {
            condition,
            genes,
            effects: Vec::new(),
        }
    }
}

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
}

/// What is wanted of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Reply {
    /// Agreement with the gauge record: an [`super::Evaluation`].
    Score {
        /// Whether the residual vector is wanted too.
        with_residual: bool,
    },
    /// The measured channels alone: an [`super::Observation`].
    Channels,
    /// Everything that can be drawn: a [`super::Simulation`].
    Curves {
        /// Spacing of the returned rope shapes on crank angle \[deg\]; 0 for none.
        motion_step_deg: f64,
    },
}
