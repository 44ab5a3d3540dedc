//! Result of a simulation limited to the case's channels, as needed by a diagnosis.
use super::derivative::Derivative;
use super::verdict::{Counters, Verdict};
use crate::{
    case::{Case, Channel},
    curve::rounded,
};
use serde::{Deserialize, Serialize};

/// Channel curves of one simulation.
///
/// The worker rounds them to the channels' own steps before any further use, so that computations, the
/// journal and reports all use the same numbers (`crate::curve`).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Observation {
    /// Verdict: whether the simulation was completed or how the simulated machine failed.
    pub verdict: Verdict,
    /// Work counters of the simulation (steps, iterations).
    pub counters: Counters,
    /// Curves of the condition's channels, in the case's order and the channel's unit; truncated where the
    /// run ended early.
    #[serde(with = "crate::curve::each")]
    pub curves: Vec<Vec<f64>>,
    /// Derivatives of the channels with respect to the requested parameters, in the order of the request;
    /// empty for a failed simulation.
    pub columns: Vec<Derivative>,
}

impl Observation {
    /// Returns the observation with its curves rounded to the steps of the channels of a condition.
    #[must_use]
    pub fn rounded(self, case: &Case, condition: usize) -> Self {
        let curves = self.curves.into_iter().zip(case.channels_of(condition));
        let round = |(curve, (_, channel)): (Vec<f64>, (usize, &Channel))| match channel.step {
            Some(exponent) => rounded(&curve, exponent),
            None => curve,
        };
        Self {
            curves: curves.map(round).collect(),
            ..self
        }
    }
}
