//! How a simulation ended, in words.
use crate::report::number::percent;
use protocol::job::{PhysicsFailure, Reached, Verdict};

/// What ended a simulation, in words.
pub fn failure(kind: PhysicsFailure) -> &'static str {
    match kind {
        PhysicsFailure::OverstretchedRope => "a rope joint was stretched beyond its limit",
        PhysicsFailure::RopeThroughHead => "the rope sank through the surface of a head",
        PhysicsFailure::BeamOvertravel => "the beam left its working range",
        PhysicsFailure::LoadNotLifted => "the load was not lifted",
        PhysicsFailure::TumbledCylinder => "a rope cylinder turned over",
        PhysicsFailure::StepUnderflow => "the step size fell below its limit",
        PhysicsFailure::Budget => {
            "the iteration budget was used up; `iteration_budget` in [run] of case.toml raises it"
        }
    }
}

/// How a simulation ended, in words, without a full stop.
pub fn verdict(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Complete => "complete revolution".to_owned(),
        Verdict::Failed { kind, reached } => {
            let reached = match reached {
                Reached::LoadFraction(share) => {
                    format!(
                        "at {} of the static load, before any motion",
                        percent(*share)
                    )
                }
                Reached::TimeFraction(share) => {
                    format!("after {} of the simulated time", percent(*share))
                }
            };
            format!("failed: {} {reached}", failure(*kind))
        }
    }
}
