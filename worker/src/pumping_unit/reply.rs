//! Conversion of verdict, counters and stress to the types and units of the protocol.
use protocol::job::{self, Counters};
use protocol::pumping_unit::failure;
use simulation::statistics::Statistics;
use simulation::verdict;

/// Converts a simulation's verdict to the protocol's type.
pub(super) const fn verdict(verdict: &verdict::Verdict) -> job::Verdict {
    match verdict {
        verdict::Verdict::Complete => job::Verdict::Complete,
        verdict::Verdict::Failed { kind, reached } => job::Verdict::Failed {
            kind: match kind {
                verdict::Failure::OverstretchedRope => failure::OVERSTRETCHED_ROPE,
                verdict::Failure::RopeThroughHead => failure::ROPE_THROUGH_HEAD,
                verdict::Failure::BeamOvertravel => failure::BEAM_OVERTRAVEL,
                verdict::Failure::LoadNotLifted => failure::LOAD_NOT_LIFTED,
                verdict::Failure::TumbledCylinder => failure::TUMBLED_CYLINDER,
                verdict::Failure::StepUnderflow => failure::STEP_UNDERFLOW,
                verdict::Failure::Budget => failure::BUDGET,
            },
            reached: match reached {
                verdict::Reached::LoadFraction(x) => job::Reached::LoadFraction(*x),
                verdict::Reached::TimeFraction(x) => job::Reached::TimeFraction(*x),
            },
        },
    }
}

/// Converts a simulation's work counters to the protocol's type.
pub(super) const fn counters(statistics: &Statistics) -> Counters {
    Counters {
        steps: statistics.steps,
        rejected_steps: statistics.error_rejections + statistics.newton_rejections,
        newton_iterations: statistics.newton_iterations,
        jacobians: statistics.jacobians,
        factorizations: statistics.factorizations,
    }
}

/// Converts stress from pascals to megapascals.
pub(super) fn megapascals(stress_pa: &[f64]) -> Vec<f64> {
    stress_pa.iter().map(|s| s * 1e-6).collect()
}
