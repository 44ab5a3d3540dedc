//! JSON objects of `horsehead calibrate` and `horsehead verify`.
use super::score::{ConditionOutput, RecommendedAndOptimised, ScoreOutput, Unknowns};
use serde::Serialize;
use std::collections::BTreeMap;

/// JSON object printed by `horsehead calibrate`, also written as `result.json` in the run folder.
#[derive(Debug, Serialize)]
pub(crate) struct CalibrateOutput<'a> {
    /// Path of the run folder.
    pub(crate) run: String,
    /// Name of the case.
    pub(crate) case: &'a str,
    /// Name of the search preset.
    pub(crate) preset: &'a str,
    /// Seed of the random number generator.
    pub(crate) seed: u64,
    /// Number of evaluated individuals.
    pub(crate) evaluations: usize,
    /// Number of evaluated individuals whose simulation did not complete.
    pub(crate) failed_simulations: usize,
    /// Wall time over all sessions (s).
    pub(crate) wall_s: f64,
    /// Identified values of the unknowns, by name.
    #[serde(flatten)]
    pub(crate) unknowns: Unknowns,
    /// Objective of both parameter sets, summed over the calibrated conditions, in the square of the unit
    /// that its channels share.
    pub(crate) objective: RecommendedAndOptimised<Option<f64>>,
    /// Agreement with the measurement by channel, of both parameter sets, at the first calibrated condition.
    pub(crate) channels: BTreeMap<String, RecommendedAndOptimised<Option<ScoreOutput>>>,
    /// Scores of both parameter sets at all other conditions with a measured record, calibrated or not, by
    /// condition name.
    pub(crate) other_conditions: BTreeMap<String, ConditionOutput>,
    /// Hash of the evaluation log of the search, in id order.
    pub(crate) log_digest: String,
    /// Paths of the files that were written.
    pub(crate) files: Vec<String>,
}

/// JSON object printed by `horsehead verify RUN --condition NAME --output json`.
#[derive(Debug, Serialize)]
pub(crate) struct VerifyOutput<'a> {
    /// Path of the run folder.
    pub(crate) run: String,
    /// Name of the case.
    pub(crate) case: &'a str,
    /// Name of the condition that took no part in the fit.
    pub(crate) condition: &'a str,
    /// Wall time of the verification (s).
    pub(crate) wall_s: f64,
    /// Scores of the recommended and the optimised parameters at the condition.
    #[serde(flatten)]
    pub(crate) scores: ConditionOutput,
}
