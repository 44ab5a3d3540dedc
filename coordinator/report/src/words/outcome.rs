//! Descriptions of how a simulation ended.
use crate::{failure, number::percent};
use protocol::job::{Identifier, Reached, Verdict};

/// Describes a failure code; a code without a description is spelled out.
pub fn failure(word: Identifier) -> String {
    failure::failure(word).map_or_else(|| word.with_spaces(), str::to_owned)
}

/// Describes how a simulation ended, without a full stop.
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
