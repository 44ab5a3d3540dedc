//! The channels of a simulation: what a diagnosis needs of a run.
use super::derivative::Derivative;
use super::verdict::{Counters, Verdict};
use crate::{
    case::{Case, Channel},
    curve::rounded,
};
use serde::{Deserialize, Serialize};

/// The channels of one run.
///
/// The worker rounds them before anybody uses them, to the channels' own steps: what a run computes
/// with, what its journal holds and what a report reads again are the same numbers
/// (`crate::curve`).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Observation {
    /// How it ended.
    pub verdict: Verdict,
    /// What it cost.
    pub counters: Counters,
    /// One curve per channel of the condition, in the case's order and the channel's unit, as far as
    /// the run got.
    #[serde(with = "crate::curve::each")]
    pub curves: Vec<Vec<f64>>,
    /// Derivatives by the columns that were asked for, in their order; none of a run that failed.
    pub columns: Vec<Derivative>,
}

impl Observation {
    /// With its curves in whole steps of their channels, those of a condition.
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
