//! Diagnosis from the record to the verdict: order of its steps (baseline, localisation, hypotheses,
//! validation) and their results.
mod acceptance;
mod backward_elimination;
mod claim;
mod conclude;
pub(crate) mod diagnosis;
mod other_starts;
mod plausibility;
mod reason;
mod remainder;
mod rivals;
mod rounds;
mod settle;
mod validate;

pub use crate::estimate::absorbed::Absorbed;
pub use crate::estimate::discrepancy::DiscrepancyEstimate;
pub use crate::estimate::effect_size::{Estimate, ParameterEstimate};
pub use crate::estimate::experiment_design::IndistinguishablePair;
pub use crate::estimate::force::ForceEstimate;
pub use crate::estimate::limit::Limit;
pub use crate::estimate::nuisances::NuisanceEstimate;
pub use crate::hypothesis::round::Round;
pub use crate::inputs::Inputs;
pub use diagnosis::Diagnosis;
pub use remainder::{Left, Remainder};

use crate::{
    baseline::{establish::establish, session::Session},
    budget::Budgeted,
    laboratory::{Laboratory, Stage},
    localisation::summary,
    thresholds::MAX_PREDICTED_DECREASE,
    validation::compare::validation_records,
};
use conclude::conclude;
use diagnosis::WorkingDiagnosis;
use rounds::rounds;

/// Runs a diagnosis within the budget of simulations.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn diagnose<L: Laboratory>(lab: &mut L, inputs: &Inputs) -> Result<Diagnosis, L::Error> {
    let budget = inputs.budget();
    let mut counted = Budgeted::new(lab, budget);
    let mut diagnosis = diagnose_budgeted(&mut counted, inputs).await?;
    diagnosis
        .notes
        .extend(counted.ran_out().iter().map(|stage| {
            format!(
                "the stage \"{}\" used up its budget of {:.0} simulations and began no further work; [diagnose] \
                 simulations of case.toml states another total",
                stage.name(),
                budget[*stage as usize]
            )
        }));
    diagnosis.ran_out = counted.ran_out().to_vec();
    if diagnosis.is_in_part() {
        diagnosis.reason = Some(diagnosis.completeness(inputs));
    }
    Ok(diagnosis.summary())
}

/// Runs a diagnosis with a simulator that enforces the budget.
async fn diagnose_budgeted<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
) -> Result<WorkingDiagnosis, L::Error> {
    let Some(record) = inputs
        .records
        .first()
        .filter(|r| !r.cycles.is_empty() && !r.held_out)
    else {
        return Ok(Diagnosis::unresolved(
            "there is no record of the calibrated condition",
        ));
    };
    let split = record.split();
    if split.fitted.channels.is_empty() {
        return Ok(Diagnosis::unresolved(
            "every channel of the calibrated condition is held out",
        ));
    }
    let base = match establish(lab, inputs, split.fitted.clone()).await? {
        Ok(base) => base.with_discrepancy(),
        Err(baseless) => return Ok(Diagnosis::unresolved(baseless.reason())),
    };
    let mut session = Session {
        lab,
        base: &base,
        inputs,
    };
    let mut diagnosis = WorkingDiagnosis {
        reason: None,
        localisation: Some(summary::localise(&mut session).await?),
        noise: base.known(),
        preflight: base.preflight.clone(),
        notes: base.notes.clone(),
        before: Some(base.fit.clone()),
        ..Diagnosis::unresolved("")
    };
    if !session.lab.has_budget(Stage::Test) {
        let reason = "the budget of the tests is used up: no effect was tested";
        diagnosis.reason = Some(reason.to_owned());
        return Ok(diagnosis);
    }
    let promised = base.fit.search.predicted_decrease();
    if promised > MAX_PREDICTED_DECREASE {
        diagnosis.reason = Some(format!(
            "the recalibration did not converge: one more step is predicted to lower the misfit by {:.0} %, \
             so that tests of effects would respond to calibration error",
            100.0 * promised
        ));
        return Ok(diagnosis);
    }
    let validation_records = validation_records(&mut session, &split).await?;
    let after = rounds(&mut session, &validation_records, &mut diagnosis).await?;
    // on the heap: its state is large, and every caller would hold it
    let concluded = conclude(&mut session, after, &validation_records, &mut diagnosis);
    Box::pin(concluded).await?;
    Ok(diagnosis)
}
