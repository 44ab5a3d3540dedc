//! The objects of `horsehead calibrate` and `horsehead verify`.
use super::score::{Both, ConditionOutput, ScoreOutput, Unknowns};
use serde::Serialize;
use std::collections::BTreeMap;

/// Of `horsehead calibrate`, and kept as `result.json` in the run folder.
#[derive(Debug, Serialize)]
pub(crate) struct CalibrateOutput<'a> {
    /// The run folder.
    pub(crate) run: String,
    /// Name of the machine.
    pub(crate) case: &'a str,
    /// The preset.
    pub(crate) preset: &'a str,
    /// The seed.
    pub(crate) seed: u64,
    /// How many individuals were evaluated.
    pub(crate) evaluations: usize,
    /// How many of them did not complete.
    pub(crate) failed_simulations: usize,
    /// Wall time over all sessions (s).
    pub(crate) wall_s: f64,
    /// The identified parameters by name.
    #[serde(flatten)]
    pub(crate) unknowns: Unknowns,
    /// Objective of both parameter sets, in the square of the unit that its channels share; the sum over the
    /// calibrated conditions.
    pub(crate) objective: Both<Option<f64>>,
    /// Agreement by channel, of both parameter sets, at the calibrated condition, the first one of several.
    pub(crate) channels: BTreeMap<String, Both<Option<ScoreOutput>>>,
    /// Other conditions with a record, by name, those that are calibrated as well among them.
    pub(crate) other_conditions: BTreeMap<String, ConditionOutput>,
    /// Hash of the evaluation log in index order.
    pub(crate) log_digest: String,
    /// Files that were written.
    pub(crate) files: Vec<String>,
}

/// Of `horsehead verify`.
#[derive(Debug, Serialize)]
pub(crate) struct VerifyOutput<'a> {
    /// The run folder.
    pub(crate) run: String,
    /// Name of the machine.
    pub(crate) case: &'a str,
    /// Name of the condition.
    pub(crate) condition: &'a str,
    /// Wall time (s).
    pub(crate) wall_s: f64,
    /// Scores of both parameter sets.
    #[serde(flatten)]
    pub(crate) scores: ConditionOutput,
}
