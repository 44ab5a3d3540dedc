//! Runner of an identification, which finds the unknowns that a measured record determines; its experiments
//! are simulations submitted as jobs to an evaluator.
use super::{
    error::StudyError,
    evaluator::Evaluator,
    experiments::{Jobs, StageCost, StageView},
    job_number::{EXPERIMENTS, IDENTIFIABILITY_JOBS},
    stop::Stop,
    watch::Watch,
};
use discrepancy::diagnose::Inputs;
use discrepancy::identify::{IdentificationResult, LinearEstimate, identify, linear_estimate};
use discrepancy::laboratory::Stage;
use protocol::case::{Case, Channel};

/// Result of an identification of unknowns, and the cost of its experiments.
#[derive(Clone, Debug)]
pub struct IdentifiedOn {
    /// Unknowns that the measured record determines, with their values; none where no fit completes.
    pub identified: Option<IdentificationResult>,
    /// Cost of the identification (experiments, batches, wall time) by stage, for stages that ran
    /// experiments.
    pub accounts: Vec<(Stage, StageCost)>,
}

/// Stages through which an identification may pass, in order.
const STAGES: [Stage; 5] = [
    Stage::Basin,
    Stage::Recalibrate,
    Stage::Preflight,
    Stage::Refit,
    Stage::Show,
];

/// Runs an identification of the unknowns that the measured record determines, with an evaluator that
/// computes its simulations.
///
/// # Errors
/// If the workers cannot build the case, no evaluator is left, or the user stops.
pub async fn identify_on<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    inputs: &Inputs,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> Result<IdentifiedOn, StudyError> {
    let of = |condition: usize| -> Vec<Channel> {
        let channels = case.channels_of(condition);
        channels.map(|(_, channel)| channel.clone()).collect()
    };
    let conditions: Vec<Vec<Channel>> = (0..case.conditions.len()).map(of).collect();
    let mut jobs = Jobs::new((evaluator, EXPERIMENTS), inputs, &STAGES, watch, stop);
    let identified = identify(&mut jobs, inputs, &conditions).await?;
    Ok(IdentifiedOn {
        identified,
        accounts: jobs.accounts(),
    })
}

/// Estimates at the start values, to first order, how well a measured record determines each unknown; none where no
/// estimate is possible.
///
/// # Errors
/// If no evaluator is left, or the user stops.
pub async fn estimate_at_start_on<E: Evaluator>(
    evaluator: &mut E,
    inputs: &Inputs,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> Result<Option<LinearEstimate>, StudyError> {
    let mut jobs = Jobs::new(
        (evaluator, IDENTIFIABILITY_JOBS),
        inputs,
        &[Stage::Show],
        watch,
        stop,
    );
    linear_estimate(&mut jobs, inputs).await
}
