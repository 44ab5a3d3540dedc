//! How a simulation ended, in words.
use crate::{failure, number::percent};
use protocol::job::{Reached, Verdict, Word};

/// What ended a simulation, in words.
pub fn failure(word: Word) -> String {
    failure::failure(word).map_or_else(|| word.spoken(), str::to_owned)
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
