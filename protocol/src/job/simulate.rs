//! What to simulate, how finely, and what to say of it: the one job of all simulations.
use super::derivative::Column;
use crate::case::EffectSetting;
use serde::{Deserialize, Serialize};

/// A simulation of an individual under one condition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulateSpec {
    /// Of what.
    pub individual: Individual,
    /// How finely, and by what method.
    pub numerics: Numerics,
    /// What is wanted of it.
    pub reply: Reply,
    /// What it is differentiated by, at most [`super::MOST_COLUMNS`]; derivatives come with curves and with
    /// residuals.
    pub columns: Vec<Column>,
}

impl SimulateSpec {
    /// A simulation that is computed as the case says.
    pub const fn new(individual: Individual, reply: Reply) -> Self {
        Self {
            individual,
            numerics: Numerics::OF_THE_CASE,
            reply,
            columns: Vec::new(),
        }
    }
}

/// How a model is computed where a job wants it otherwise than the case: bytes that the model alone
/// understands, as its own part of the case is. Empty: as the case says.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Numerics(#[serde(with = "serde_bytes")] pub Vec<u8>);

impl Numerics {
    /// Nothing is computed otherwise than the case says.
    pub const OF_THE_CASE: Self = Self(Vec::new());
}

/// What is simulated under a condition: values of the unknowns, and effects beside those of the case.
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
    /// Agreement with the record: an [`super::Evaluation`].
    Score {
        /// Whether the residual vector is wanted too.
        with_residual: bool,
        /// Whether it is simulated under every condition of the objective, of which its own is the first, and
        /// their scores are joined; else under its own alone.
        whole: bool,
    },
    /// The measured channels alone: an [`super::Observation`].
    Channels,
    /// Everything that can be drawn: a [`super::Curves`].
    Curves {
        /// Pictures of what moves, over the whole run; 0 for none.
        pictures: u32,
    },
}
