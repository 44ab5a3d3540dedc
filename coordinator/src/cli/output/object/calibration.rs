//! JSON objects of `horsehead calibrate` and `horsehead verify`.
use super::score::{ConditionOutput, RecommendedAndOptimised, ScoreOutput, Unknowns};
use protocol::case::Case;
use report::{MachineCheck, RivalFit};
use serde::Serialize;
use std::collections::BTreeMap;

/// JSON object printed by `horsehead calibrate`, also written as `result.json` in the run folder.
#[derive(Debug, Serialize)]
pub(crate) struct CalibrateOutput<'a> {
    pub(crate) run: String,
    pub(crate) case: &'a str,
    pub(crate) preset: &'a str,
    pub(crate) seed: u64,
    pub(crate) evaluations: usize,
    /// Number of evaluated individuals whose simulation did not complete.
    pub(crate) failed_simulations: usize,
    /// Wall time of the run over all its sessions (s).
    pub(crate) wall_s: f64,
    /// Identified values of the unknowns, by name.
    #[serde(flatten)]
    pub(crate) unknowns: Unknowns,
    /// Objective of the recommended and the optimised parameters, summed over the calibrated conditions, in
    /// the square of the unit that its channels share.
    pub(crate) objective: RecommendedAndOptimised<Option<f64>>,
    /// Fits of other families whose objective lies near that of the optimised parameters, best first.
    pub(crate) rivals: Vec<RivalOutput>,
    /// Agreement between simulation and measurement by channel, for the recommended and the optimised
    /// parameters, at the first calibrated condition.
    pub(crate) channels: BTreeMap<String, RecommendedAndOptimised<Option<ScoreOutput>>>,
    /// Scores of the recommended and the optimised parameters at all other conditions with a measured record,
    /// calibrated or not, by condition name.
    pub(crate) other_conditions: BTreeMap<String, ConditionOutput>,
    /// Quantities of the machine under every condition by which the fit is judged, with the recommended (`before`) and
    /// the optimised (`after`) parameters; empty for kinds of model that have none.
    pub(crate) machine: Vec<MachineCheck>,
    /// Hash of the search's evaluation log, in id order, by which two runs can be compared.
    pub(crate) log_digest: String,
    /// Paths of the result files that were written.
    pub(crate) files: Vec<String>,
}

/// Fit of another family than the optimised parameters.
#[derive(Debug, Serialize)]
pub(crate) struct RivalOutput {
    objective: f64,
    /// Names of the unknowns in which the fit differs from the optimised parameters.
    differs: Vec<String>,
    /// Values of the unknowns, by name.
    values: BTreeMap<String, f64>,
}

impl RivalOutput {
    /// Converts a fit of the unknowns of a case.
    pub(crate) fn new(case: &Case, rival: &RivalFit) -> Self {
        let names = case.unknowns.iter().map(|unknown| unknown.name.clone());
        Self {
            objective: rival.objective,
            differs: rival.differs.clone(),
            values: names.zip(rival.genes.iter().copied()).collect(),
        }
    }
}

/// JSON object printed by `horsehead verify RUN --condition NAME --output json`.
#[derive(Debug, Serialize)]
pub(crate) struct VerifyOutput<'a> {
    pub(crate) run: String,
    pub(crate) case: &'a str,
    /// Name of the condition that took no part in the fit.
    pub(crate) condition: &'a str,
    /// Wall time of the verification (s).
    pub(crate) wall_s: f64,
    /// Scores of the recommended and the optimised parameters at the condition.
    #[serde(flatten)]
    pub(crate) scores: ConditionOutput,
    /// Quantities of the machine, as those of a calibration.
    pub(crate) machine: Vec<MachineCheck>,
}
