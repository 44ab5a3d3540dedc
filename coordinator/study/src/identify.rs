//! Identification, which finds the unknowns that a measured record determines, with experiments as jobs of an
//! evaluator.
use super::{
    error::StudyError,
    evaluator::Evaluator,
    job_number::{EXPERIMENTS, FIRST_LOOK},
    laboratory::{Jobs, StageCost, StageView},
    stop::Stop,
    watch::Watch,
};
use discrepancy::diagnose::Inputs;
use discrepancy::identify::{Identified, UnknownEstimate, glance, identify};
use discrepancy::laboratory::Stage;
use protocol::case::{Case, Channel};

/// Result of an identification, and its cost.
#[derive(Clone, Debug)]
pub struct IdentifiedOn {
    /// Result of the identification; none where no fit completes.
    pub identified: Option<Identified>,
    /// Cost of each stage that did experiments.
    pub accounts: Vec<(Stage, StageCost)>,
}

/// Stages that an identification may have.
const STAGES: [Stage; 5] = [
    Stage::Basin,
    Stage::Recalibrate,
    Stage::Preflight,
    Stage::Refit,
    Stage::Show,
];

/// Runs an identification on an evaluator.
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

/// Estimates at the start values how well a measured record determines each unknown; none where no estimate
/// is possible.
///
/// # Errors
/// If no evaluator is left, or the user stops.
pub async fn glance_on<E: Evaluator>(
    evaluator: &mut E,
    inputs: &Inputs,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> Result<Option<Vec<UnknownEstimate>>, StudyError> {
    let mut jobs = Jobs::new((evaluator, FIRST_LOOK), inputs, &[Stage::Show], watch, stop);
    glance(&mut jobs, inputs).await
}
