//! Derivatives of a simulation with respect to requested parameters, each a column of the Jacobian of the
//! channels.
use serde::{Deserialize, Serialize};
use std::fmt;

/// Largest number of derivative columns in one job, so that the answer fits into one message.
pub const MAX_COLUMNS: usize = 500;

/// Quantity with respect to which a simulation is differentiated: one column of the Jacobian.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Name of an unknown of the case, or `EFFECT.PARAMETER` of an effect, whether or not the case contains
    /// that effect.
    pub name: String,
    /// Values, by name and in declared units, of the parameters of an effect that is not part of the case. A
    /// parameter that is not listed takes the value at which the effect vanishes (sizes) or its typical value
    /// (shapes).
    pub values: Vec<(String, f64)>,
}

impl Column {
    /// Creates a column for an unknown or an effect parameter that the case contains.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            values: Vec::new(),
        }
    }
}

/// Unit of change of a parameter to which a derivative refers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Per {
    /// Derivative per factor of ten in the parameter's value.
    Decade,
    /// Derivative per one unit, named here, of the parameter's value.
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

/// Derivative of all channels of a simulation with respect to one parameter, i.e. a column of the Jacobian.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Derivative {
    /// The model computed the derivative.
    Curves {
        /// Unit of change of the parameter to which the derivative refers.
        per: Per,
        /// Derivative curves, one per channel of the condition in the case's order, in the channel's unit per
        /// `per`; empty for a channel that the model does not differentiate. Single precision suffices: about
        /// four digits of a derivative are exact.
        curves: Vec<Vec<f32>>,
    },
    /// The derivative is zero everywhere: in this model the parameter has no influence on any channel.
    Nothing {
        /// Unit of change of the parameter to which the derivative refers.
        per: Per,
    },
    /// The model cannot compute the derivative; finite differences of whole runs are needed.
    Missing {
        /// Reason why the derivative is not available.
        reason: String,
    },
}

impl Derivative {
    /// Returns [`Derivative::Missing`] for every requested derivative, for a model that computes none.
    pub fn none(columns: &[Column]) -> Vec<Self> {
        let none = |_: &Column| Self::Missing {
            reason: "this model gives no derivatives".to_owned(),
        };
        columns.iter().map(none).collect()
    }
}

/// Converts a curve to single precision, in which derivatives are transmitted.
#[expect(
    clippy::cast_possible_truncation,
    reason = "derivatives travel in single precision"
)]
pub fn to_single_precision(curve: impl IntoIterator<Item = f64>) -> Vec<f32> {
    curve.into_iter().map(|x| x as f32).collect()
}
