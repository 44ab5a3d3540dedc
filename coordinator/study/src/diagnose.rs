//! A diagnosis on the workers.
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

/// A finished diagnosis, and what it cost.
#[derive(Clone, Debug)]
pub struct Diagnosed {
    /// The answer.
    pub diagnosis: Diagnosis,
    /// Stages that did experiments.
    pub accounts: Vec<(Stage, StageCost)>,
}

/// Diagnoses on an evaluator.
///
/// # Errors
/// If the workers cannot build the case or an effect, nobody evaluates any more, or the user stops.
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
