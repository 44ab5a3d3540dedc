//! How a run ended and what it cost, as it travels.
use protocol::job::{self, Counters};
use simulation::statistics::Statistics;
use simulation::verdict;

/// A verdict as it travels.
pub(super) const fn verdict(verdict: &verdict::Verdict) -> job::Verdict {
    match verdict {
        verdict::Verdict::Complete => job::Verdict::Complete,
        verdict::Verdict::Failed { kind, reached } => job::Verdict::Failed {
            kind: match kind {
                verdict::Failure::OverstretchedRope => job::PhysicsFailure::OverstretchedRope,
                verdict::Failure::RopeThroughHead => job::PhysicsFailure::RopeThroughHead,
                verdict::Failure::BeamOvertravel => job::PhysicsFailure::BeamOvertravel,
                verdict::Failure::LoadNotLifted => job::PhysicsFailure::LoadNotLifted,
                verdict::Failure::TumbledCylinder => job::PhysicsFailure::TumbledCylinder,
                verdict::Failure::StepUnderflow => job::PhysicsFailure::StepUnderflow,
                verdict::Failure::Budget => job::PhysicsFailure::Budget,
            },
            reached: match reached {
                verdict::Reached::LoadFraction(x) => job::Reached::LoadFraction(*x),
                verdict::Reached::TimeFraction(x) => job::Reached::TimeFraction(*x),
            },
        },
    }
}

/// Counters as they travel.
pub(super) const fn counters(statistics: &Statistics) -> Counters {
    Counters {
        steps: statistics.steps,
        rejected_steps: statistics.error_rejections + statistics.newton_rejections,
        newton_iterations: statistics.newton_iterations,
        jacobians: statistics.jacobians,
        factorizations: statistics.factorizations,
    }
}
