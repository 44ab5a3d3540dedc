//! Runner of an identification, which finds the unknowns that a measured record determines; its experiments
//! are simulations submitted as jobs to an evaluator.
use super::{
    entry::IdentificationStudy,
    error::StudyError,
    evaluator::Evaluator,
    experiments::{Jobs, StageView, enter_budget},
    stop::Stop,
    watch::Watch,
};
use discrepancy::diagnose::Inputs;
use discrepancy::estimate::neighbourhood::{Neighbourhood, NoNeighbourhood};
use discrepancy::identify::{LinearEstimate, identify, linear_estimate, neighbourhood_at_start};
use discrepancy::laboratory::Stage;
use journal::job_range::{EXPERIMENTS, IDENTIFIABILITY};
use protocol::case::{Case, Channel};

/// Stages through which an identification may pass, in order.
const STAGES: [Stage; 5] = [
    Stage::Basin,
    Stage::Recalibrate,
    Stage::Preflight,
    Stage::Refit,
    Stage::Show,
];

/// Runs an identification of the unknowns that the measured record determines, with an evaluator that
/// computes its simulations; `None` where no fit completes. The notes of the result are empty.
///
/// # Errors
/// If the workers cannot build the case, no evaluator is left, or the user stops.
pub async fn identify_on<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    inputs: &Inputs,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> Result<Option<IdentificationStudy>, StudyError> {
    let of = |condition: usize| -> Vec<Channel> {
        let channels = case.channels_of(condition);
        channels.map(|(_, channel)| channel.clone()).collect()
    };
    let conditions: Vec<Vec<Channel>> = (0..case.conditions.len()).map(of).collect();
    enter_budget(evaluator, inputs, &STAGES)?;
    let mut jobs = Jobs::new((evaluator, EXPERIMENTS), inputs, &STAGES, watch, stop);
    let identified = identify(&mut jobs, inputs, &conditions).await?;
    let accounts = jobs.accounts();
    let simulations = accounts.iter().map(|(_, cost)| cost.experiments).sum();
    Ok(identified.map(|identified| IdentificationStudy {
        identified,
        simulations,
        notes: Vec::new(),
    }))
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
    linear_estimate(&mut jobs_at_start(evaluator, inputs, watch, stop), inputs).await
}

/// Collects individuals about the start values, by which any quantity of the machine has an interval, as
/// [`neighbourhood_at_start`].
///
/// # Errors
/// If no evaluator is left, or the user stops.
pub async fn neighbourhood_at_start_on<E: Evaluator>(
    evaluator: &mut E,
    inputs: &Inputs,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> Result<Option<Result<Neighbourhood, NoNeighbourhood>>, StudyError> {
    neighbourhood_at_start(&mut jobs_at_start(evaluator, inputs, watch, stop), inputs).await
}

/// Returns the jobs of an estimate at the start values.
fn jobs_at_start<'a, E: Evaluator>(
    evaluator: &'a mut E,
    inputs: &Inputs,
    watch: &'a mut dyn Watch<StageView>,
    stop: &'a mut Stop,
) -> Jobs<'a, E> {
    let from = (evaluator, IDENTIFIABILITY);
    Jobs::new(from, inputs, &[Stage::Show], watch, stop)
}
