//! Result of a simulation with all data that can be plotted.
use super::derivative::Derivative;
use super::verdict::{Counters, Verdict};
use serde::{Deserialize, Serialize};

/// Curves of one simulation with all further data that can be plotted, exactly as computed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curves {
    /// Verdict: whether the simulation was completed or how the simulated machine failed.
    pub verdict: Verdict,
    /// Work counters of the simulation (steps, iterations).
    pub counters: Counters,
    /// Wall time on the worker \[s\]; not part of any digest.
    pub wall_s: f64,
    /// Curves of the condition's channels, in the case's order and the channel's unit; truncated where the
    /// run ended early.
    pub channels: Vec<Vec<f64>>,
    /// Derivatives of the channels with respect to the requested parameters, in the order of the request;
    /// empty for a failed simulation.
    pub columns: Vec<Derivative>,
    /// Wall time of the simulation including all its derivatives \[s\]; 0 if none were requested.
    pub columns_wall_s: f64,
    /// Further model output, in an encoding that only the model understands; empty if there is none.
    #[serde(with = "serde_bytes")]
    pub details: Vec<u8>,
}
