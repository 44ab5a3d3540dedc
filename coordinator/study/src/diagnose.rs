//! Runner of the diagnosis of model deficiencies; its experiments are simulations submitted as jobs to an
//! evaluator.
use super::{
    entry::DiagnosisResult,
    error::StudyError,
    evaluator::Evaluator,
    experiments::{Jobs, StageView, enter_budget},
    stop::Stop,
    watch::Watch,
};
use discrepancy::diagnose::{Inputs, diagnose};
use discrepancy::laboratory::Stage;
use discrepancy::model::InactiveUnknowns;
use journal::job_range::EXPERIMENTS;

/// Runs a diagnosis of model deficiencies, with an evaluator that computes its simulations; the notes of the result
/// are empty.
///
/// # Errors
/// If the workers cannot build the case or an effect, no evaluator is left, or the user stops.
pub async fn diagnose_on<E: Evaluator>(
    evaluator: &mut E,
    inputs: &Inputs,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> Result<DiagnosisResult, StudyError> {
    enter_budget(evaluator, inputs, &Stage::ALL)?;
    let mut jobs = Jobs::new((evaluator, EXPERIMENTS), inputs, &Stage::ALL, watch, stop);
    let diagnosis = diagnose(&mut jobs, inputs).await?;
    let off = InactiveUnknowns::of(&inputs.unknowns).into_iter();
    let off = off.map(|off| off.candidate);
    Ok(DiagnosisResult {
        diagnosis,
        accounts: jobs.accounts(),
        library: inputs.library.iter().cloned().chain(off).collect(),
        notes: Vec::new(),
    })
}
