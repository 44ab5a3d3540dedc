//! What a simulation is differentiated by, and what comes of it.
use serde::{Deserialize, Serialize};
use std::fmt;

/// Most columns of one job: what comes back must fit into a message.
pub const MOST_COLUMNS: usize = 500;

/// What a simulation is differentiated by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// An unknown of the case, or `EFFECT.PARAMETER` of an effect, whether the case has it or not.
    pub name: String,
    /// Values of the parameters of an effect that the case does not have, by name, in their declared
    /// units; what is not named is absent (sizes) or typical (shapes).
    pub values: Vec<(String, f64)>,
}

impl Column {
    /// By something that the case has.
    pub fn of(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            values: Vec::new(),
        }
    }
}

/// By how much of it a derivative is taken.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Per {
    /// A decade of the value.
    Decade,
    /// One of a unit.
    Unit(String),
}

impl fmt::Display for Per {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Decade => f.write_str("decade"),
            Self::Unit(unit) => f.write_str(unit),
        }
    }
}

/// The derivative of a simulation's channels by one column.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Derivative {
    /// It has one.
    Curves {
        /// By how much of it.
        per: Per,
        /// One curve per channel of the condition, in the case's order, in the channel's unit per `per`;
        /// empty for a channel that the model does not differentiate. In single precision: four digits
        /// of a derivative are exact.
        curves: Vec<Vec<f32>>,
    },
    /// It changes nothing, as the model is: zeros everywhere.
    Nothing {
        /// As above.
        per: Per,
    },
    /// It has none, and differences of whole runs must do.
    Missing {
        /// Why.
        reason: String,
    },
}

impl Derivative {
    /// Of a model that differentiates nothing: differences must do for every column.
    pub fn none(columns: &[Column]) -> Vec<Self> {
        let none = |_: &Column| Self::Missing {
            reason: "this model gives no derivatives".to_owned(),
        };
        columns.iter().map(none).collect()
    }
}

/// A curve in the precision in which derivatives travel.
#[expect(
    clippy::cast_possible_truncation,
    reason = "derivatives travel in single precision"
)]
pub fn single(curve: impl IntoIterator<Item = f64>) -> Vec<f32> {
    curve.into_iter().map(|x| x as f32).collect()
}
