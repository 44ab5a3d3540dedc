//! How a simulation ended, and what it cost.
use super::word::Word;
use serde::{Deserialize, Serialize};

/// How a simulation ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Verdict {
    /// The whole revolution was simulated.
    Complete,
    /// The machine failed on the way; data for the search, never retried.
    Failed {
        /// What happened, in the word of its model.
        kind: Word,
        /// How far it got.
        reached: Reached,
    },
}

impl Verdict {
    /// `complete`, or what ended it early, as written in tables.
    pub fn as_str(&self) -> &str {
        match self {
            Self::Complete => "complete",
            Self::Failed { kind, .. } => kind.as_str(),
        }
    }

    /// Share of the static load that it failed at \[1\]; none if it got further.
    pub const fn load_fraction(&self) -> Option<f64> {
        match self {
            Self::Failed {
                reached: Reached::LoadFraction(share),
                ..
            } => Some(*share),
            Self::Failed { .. } | Self::Complete => None,
        }
    }

    /// Share of the simulated time that it failed at \[1\]; none if it did not get so far or is
    /// complete.
    pub const fn time_fraction(&self) -> Option<f64> {
        match self {
            Self::Failed {
                reached: Reached::TimeFraction(share),
                ..
            } => Some(*share),
            Self::Failed { .. } | Self::Complete => None,
        }
    }
}

/// How far a failed simulation got.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Reached {
    /// It failed while the static load was applied.
    LoadFraction(f64),
    /// It failed in motion, after this share of the simulated time.
    TimeFraction(f64),
}

/// Work counters of one simulation; deterministic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected_steps: u64,
    /// Newton iterations, settle included.
    pub newton_iterations: u64,
    /// Tangent evaluations.
    pub jacobians: u64,
    /// Factorisations.
    pub factorizations: u64,
}

impl Counters {
    /// Adds the work of another simulation.
    pub const fn add(&mut self, other: &Self) {
        self.steps = self.steps.saturating_add(other.steps);
        self.rejected_steps = self.rejected_steps.saturating_add(other.rejected_steps);
        self.newton_iterations = self
            .newton_iterations
            .saturating_add(other.newton_iterations);
        self.jacobians = self.jacobians.saturating_add(other.jacobians);
        self.factorizations = self.factorizations.saturating_add(other.factorizations);
    }

    /// Each with the name that tables and files give it and with what it counts, in one order for
    /// all of them.
    pub const fn named(&self) -> [(&'static str, &'static str, u64); 5] {
        [
            ("steps", "accepted steps", self.steps),
            ("rejected_steps", "rejected steps", self.rejected_steps),
            (
                "newton_iterations",
                "Newton iterations",
                self.newton_iterations,
            ),
            ("jacobians", "tangent evaluations", self.jacobians),
            ("factorizations", "factorisations", self.factorizations),
        ]
    }
}
