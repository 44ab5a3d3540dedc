//! What a record sees, on the workers.
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

/// A finished identification, and what it cost.
#[derive(Clone, Debug)]
pub struct IdentifiedOn {
    /// The answer; none where no fit completes.
    pub identified: Option<Identified>,
    /// Stages that did experiments.
    pub accounts: Vec<(Stage, StageCost)>,
}

/// Stages that there may be.
const STAGES: [Stage; 5] = [
    Stage::Basin,
    Stage::Recalibrate,
    Stage::Preflight,
    Stage::Refit,
    Stage::Show,
];

/// Identifies on an evaluator.
///
/// # Errors
/// If the workers cannot build the case, nobody evaluates any more, or the user stops.
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

/// A first look at what a record sees, where the inputs start; nothing where that cannot be said.
///
/// # Errors
/// If nobody evaluates any more, or the user stops.
pub async fn glance_on<E: Evaluator>(
    evaluator: &mut E,
    inputs: &Inputs,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> Result<Option<Vec<UnknownEstimate>>, StudyError> {
    let mut jobs = Jobs::new((evaluator, FIRST_LOOK), inputs, &[Stage::Show], watch, stop);
    glance(&mut jobs, inputs).await
}
