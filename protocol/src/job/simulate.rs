//! What to simulate, how finely, and what to say of it: the one job of all simulations.
use crate::{case::EffectSetting, pumping_unit::Discretisation};
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
    /// Everything that can be drawn: a [`super::Curves`].
    Curves {
        /// Spacing of the returned rope shapes on crank angle \[deg\]; 0 for none.
        motion_step_deg: f64,
    },
}
