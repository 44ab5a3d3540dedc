//! What a calibration minimises: mean squared errors of chosen channels.
use serde::{Deserialize, Serialize};

/// Weighted sum of mean squared errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Objective {
    /// Index of the condition that is calibrated.
    pub condition: usize,
    /// What is summed; the same under every condition that is scored.
    pub terms: Vec<Term>,
    /// Treatment of the zero of each channel.
    pub offset: Offset,
}

/// One channel of an objective.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Term {
    /// Name of the channel.
    pub channel: String,
    /// Factor of its mean squared error.
    pub weight: f64,
}

/// Treatment of a channel's zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Offset {
    /// The sensor has no absolute zero: the mean difference is removed first.
    Free,
    /// Absolute values are compared.
    Fixed,
}

impl Objective {
    /// Whether a channel of this name is summed.
    pub fn names(&self, channel: &str) -> bool {
        self.terms.iter().any(|term| term.channel == channel)
    }
}
