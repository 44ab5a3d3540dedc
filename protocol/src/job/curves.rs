//! Everything of a simulation that can be drawn.
use super::derivative::Derivative;
use super::verdict::{Counters, Verdict};
use serde::{Deserialize, Serialize};

/// The curves of one run, exactly as computed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curves {
    /// How it ended.
    pub verdict: Verdict,
    /// What it cost.
    pub counters: Counters,
    /// Wall time on the worker \[s\]; not part of any digest.
    pub wall_s: f64,
    /// One curve per channel of the condition, in the case's order and the channel's unit, as far as
    /// the run got.
    pub channels: Vec<Vec<f64>>,
    /// Derivatives by the columns that were asked for, in their order; none of a run that failed.
    pub columns: Vec<Derivative>,
    /// Wall time of the run with all its columns \[s\]; 0 where none were asked for.
    pub columns_wall_s: f64,
    /// What else the model can show, as it alone understands it; empty where it has nothing more.
    #[serde(with = "serde_bytes")]
    pub details: Vec<u8>,
}
