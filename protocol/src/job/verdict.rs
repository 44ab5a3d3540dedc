//! Verdict on a simulation and its work counters.
use super::identifier::Identifier;
use serde::{Deserialize, Serialize};

/// Verdict on a simulation: complete, or failed with the cause and the progress.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Verdict {
    /// The whole revolution was simulated.
    Complete,
    /// The simulation failed for a physical or numerical reason; data for the search, never retried.
    Failed {
        /// Cause of the failure, as named by the model.
        kind: Identifier,
        /// Progress of the simulation when it failed.
        reached: Reached,
    },
}

impl Verdict {
    /// Returns `complete` or the name of the cause of failure, as written in tables.
    pub fn as_str(&self) -> &str {
        match self {
            Self::Complete => "complete",
            Self::Failed { kind, .. } => kind.as_str(),
        }
    }

    /// Returns the share of the static load at which the simulation failed \[1\]; `None` if it reached
    /// motion.
    pub const fn load_fraction(&self) -> Option<f64> {
        match self {
            Self::Failed {
                reached: Reached::LoadFraction(share),
                ..
            } => Some(*share),
            Self::Failed { .. } | Self::Complete => None,
        }
    }

    /// Returns the share of the simulated time at which the simulation failed \[1\]; `None` if it failed
    /// before motion or is complete.
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

/// Progress that a failed simulation had made: share of the static load or of the simulated time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Reached {
    /// Failure while the static load was applied: share of the load reached \[1\].
    LoadFraction(f64),
    /// Failure in motion: share of the simulated time reached \[1\].
    TimeFraction(f64),
}

/// Work counters of one simulation, identical in every repetition.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Number of time steps that the integrator accepted.
    pub steps: u64,
    /// Number of time steps that the integrator rejected and repeated.
    pub rejected_steps: u64,
    /// Number of Newton iterations, including those of the static equilibrium.
    pub newton_iterations: u64,
    /// Number of tangent (Jacobian) evaluations.
    pub jacobians: u64,
    /// Number of matrix factorisations.
    pub factorizations: u64,
}

impl Counters {
    /// Adds the counters of another simulation; sums saturate instead of overflowing.
    pub const fn add(&mut self, other: &Self) {
        self.steps = self.steps.saturating_add(other.steps);
        self.rejected_steps = self.rejected_steps.saturating_add(other.rejected_steps);
        self.newton_iterations = self
            .newton_iterations
            .saturating_add(other.newton_iterations);
        self.jacobians = self.jacobians.saturating_add(other.jacobians);
        self.factorizations = self.factorizations.saturating_add(other.factorizations);
    }

    /// Returns each counter with its name in tables and files and with a description; the order is the same
    /// wherever counters are listed.
    pub const fn labelled(&self) -> [(&'static str, &'static str, u64); 5] {
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
