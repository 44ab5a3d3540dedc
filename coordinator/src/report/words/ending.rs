//! How a simulation ended, in words.
use crate::report::number::percent;
use protocol::job::{Reached, Verdict, Word};
use protocol::pumping_unit::failure;

/// What ended a simulation, in words.
pub fn failure(kind: Word) -> String {
    let mut known = failure::ALL.iter();
    let known = known.find(|(word, _)| *word == kind);
    known.map_or_else(|| kind.spoken(), |(_, words)| (*words).to_owned())
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
