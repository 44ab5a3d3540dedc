//! Simulation job: individual, numerical settings, requested reply and derivatives.
use super::derivative::Column;
use crate::case::EffectSetting;
use serde::{Deserialize, Serialize};

/// Request to simulate an individual under one condition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulateSpec {
    /// Individual to simulate.
    pub individual: Individual,
    /// Numerical settings that override those of the case.
    pub numerics: Numerics,
    /// Kind of answer requested.
    pub reply: Reply,
    /// Unknowns and effect parameters by which derivatives are requested, at most [`super::MAX_COLUMNS`];
    /// derivatives are returned with curves and with residuals.
    pub columns: Vec<Column>,
}

impl SimulateSpec {
    /// Creates a simulation with the numerical settings of the case and without derivatives.
    pub const fn new(individual: Individual, reply: Reply) -> Self {
        Self {
            individual,
            numerics: Numerics::FROM_CASE,
            reply,
            columns: Vec::new(),
        }
    }
}

/// Numerical settings of one job that override those of the case, as bytes that only the model understands,
/// like the model settings in the case. Empty: the settings of the case apply.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Numerics(#[serde(with = "serde_bytes")] pub Vec<u8>);

impl Numerics {
    /// Empty override: the numerical settings of the case apply.
    pub const FROM_CASE: Self = Self(Vec::new());
}

/// Individual under one condition: values of the unknowns, and effects in addition to those of the case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Individual {
    /// Index in the case of the condition under which the individual is simulated.
    pub condition: usize,
    /// Values of the unknowns in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// Effects in addition to those of the case; an effect with the identifier of one of the case's replaces
    /// it.
    pub effects: Vec<EffectSetting>,
}

impl Individual {
    /// Creates an individual with the effects of the case only.
    pub const fn new(condition: usize, genes: Vec<f64>) -> Self {
        Self {
            condition,
            genes,
            effects: Vec::new(),
        }
    }
}

/// Kind of answer requested from a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Reply {
    /// Agreement with the measured records: an [`super::Evaluation`].
    Score {
        /// Whether the residual vector is returned too.
        with_residual: bool,
        /// Whether every condition of the objective is simulated, the individual's own condition first, and
        /// their scores are combined; otherwise only the individual's own condition.
        whole: bool,
    },
    /// Measured channels only: an [`super::Observation`].
    Channels,
    /// All curves and snapshots that can be plotted: a [`super::Curves`].
    Curves {
        /// Number of snapshots of the moving machine, over the whole run; 0 for none.
        pictures: u32,
    },
}
