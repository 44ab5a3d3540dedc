//! What a calibration minimises: mean squared errors of chosen channels.
use serde::{Deserialize, Serialize};

/// Weighted sum of mean squared errors.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Objective {
    /// Index of the condition that is calibrated, the first one of several.
    pub condition: usize,
    /// Further conditions that are calibrated with it: an individual is simulated under each, and their sums are
    /// added up.
    pub others: Vec<usize>,
    /// What is summed; the same under every condition that is scored.
    pub terms: Vec<Term>,
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Offset {
    /// The sensor has no absolute zero: the mean difference is removed first, and only how it moves counts.
    #[default]
    Free,
    /// Absolute values are compared: the constant of a difference counts.
    Fixed,
}

impl Objective {
    /// The conditions that are calibrated, the first one first.
    pub fn conditions(&self) -> impl Iterator<Item = usize> {
        std::iter::once(self.condition).chain(self.others.iter().copied())
    }

    /// Whether a condition is calibrated.
    pub fn holds(&self, condition: usize) -> bool {
        self.conditions().any(|own| own == condition)
    }

    /// Whether a channel of this name is summed.
    pub fn names(&self, channel: &str) -> bool {
        self.terms.iter().any(|term| term.channel == channel)
    }
}
