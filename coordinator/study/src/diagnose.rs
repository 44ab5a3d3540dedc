//! Diagnosis whose experiments are jobs of an evaluator.
use super::{
    error::StudyError,
    evaluator::Evaluator,
    job_number::EXPERIMENTS,
    laboratory::{Jobs, StageCost, StageView},
    stop::Stop,
    watch::Watch,
};
use discrepancy::diagnose::{Diagnosis, Inputs, diagnose};
use discrepancy::laboratory::Stage;

/// Result of a diagnosis, and its cost.
#[derive(Clone, Debug)]
pub struct Diagnosed {
    /// Result of the diagnosis.
    pub diagnosis: Diagnosis,
    /// Cost of each stage that did experiments.
    pub accounts: Vec<(Stage, StageCost)>,
}

/// Runs a diagnosis on an evaluator.
///
/// # Errors
/// If the workers cannot build the case or an effect, no evaluator is left, or the user stops.
pub async fn diagnose_on<E: Evaluator>(
    evaluator: &mut E,
    inputs: &Inputs,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> Result<Diagnosed, StudyError> {
    let mut jobs = Jobs::new((evaluator, EXPERIMENTS), inputs, &Stage::ALL, watch, stop);
    let diagnosis = diagnose(&mut jobs, inputs).await?;
    Ok(Diagnosed {
        diagnosis,
        accounts: jobs.accounts(),
    })
}
