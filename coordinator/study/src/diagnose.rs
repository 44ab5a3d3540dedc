//! Runner of the diagnosis of model deficiencies; its experiments are simulations submitted as jobs to an
//! evaluator.
use super::{
    error::StudyError,
    evaluator::Evaluator,
    experiments::{Jobs, StageCost, StageView},
    job_number::EXPERIMENTS,
    stop::Stop,
    watch::Watch,
};
use discrepancy::diagnose::{Diagnosis, Inputs, diagnose};
use discrepancy::laboratory::Stage;

/// Result of a diagnosis of model deficiencies, and the cost of its experiments.
#[derive(Clone, Debug)]
pub struct DiagnosisResult {
    /// Findings of the diagnosis: possible model deficiencies and how well each explains the measured
    /// records.
    pub diagnosis: Diagnosis,
    /// Cost of the diagnosis (experiments, batches, wall time) by stage, for stages that ran experiments.
    pub accounts: Vec<(Stage, StageCost)>,
}

/// Runs a diagnosis of model deficiencies, with an evaluator that computes its simulations.
///
/// # Errors
/// If the workers cannot build the case or an effect, no evaluator is left, or the user stops.
pub async fn diagnose_on<E: Evaluator>(
    evaluator: &mut E,
    inputs: &Inputs,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> Result<DiagnosisResult, StudyError> {
    let mut jobs = Jobs::new((evaluator, EXPERIMENTS), inputs, &Stage::ALL, watch, stop);
    let diagnosis = diagnose(&mut jobs, inputs).await?;
    Ok(DiagnosisResult {
        diagnosis,
        accounts: jobs.accounts(),
    })
}
