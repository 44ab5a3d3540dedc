//! Objective of a calibration: weighted mean squared errors of selected channels.
use serde::{Deserialize, Serialize};

/// Objective of a calibration: weighted sum of the mean squared errors of selected channels.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Objective {
    /// Index of the calibrated condition; the first one if several are calibrated.
    pub condition: usize,
    /// Further calibrated conditions: an individual is simulated under each, and their sums of errors, times
    /// their weights, are added to that of the first.
    pub others: Vec<WeightedCondition>,
    /// Weighted channels of the objective, the same under every calibrated condition.
    pub terms: Vec<Term>,
}

/// Calibrated condition with the weight of its errors in the objective.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WeightedCondition {
    /// Index of the condition in the case.
    pub condition: usize,
    /// Factor on the errors under this condition, relative to those under the first one.
    pub weight: f64,
}

/// Term of an objective: a channel with the weight of its mean squared error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Term {
    /// Name of the channel in the term.
    pub channel: String,
    /// Factor on the mean squared error of the channel.
    pub weight: f64,
}

/// Treatment of a constant difference between a measured and a simulated channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Offset {
    /// No absolute zero: the mean difference is removed first, so only the variation counts.
    #[default]
    Free,
    /// Channel has an absolute zero: a constant difference counts as an error.
    Fixed,
}

impl Objective {
    /// Returns the indices of the calibrated conditions, beginning with [`Self::condition`].
    pub fn conditions(&self) -> impl Iterator<Item = usize> {
        self.weighted_conditions().map(|one| one.condition)
    }

    /// Returns the calibrated conditions with their weights, beginning with [`Self::condition`], whose weight
    /// is 1.
    pub fn weighted_conditions(&self) -> impl Iterator<Item = WeightedCondition> {
        let first = WeightedCondition {
            condition: self.condition,
            weight: 1.0,
        };
        std::iter::once(first).chain(self.others.iter().copied())
    }

    /// Returns whether a condition takes part in the objective.
    pub fn holds(&self, condition: usize) -> bool {
        self.conditions().any(|own| own == condition)
    }

    /// Returns whether a channel of this name is part of the objective.
    pub fn names(&self, channel: &str) -> bool {
        self.terms.iter().any(|term| term.channel == channel)
    }
}
