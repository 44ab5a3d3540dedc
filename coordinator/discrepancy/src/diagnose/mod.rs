//! Diagnosis from the record to the verdict: order of its steps (baseline, localisation, hypotheses,
//! validation) and their results.
mod belief;
mod carry;
mod claim;
mod conclude;
mod correlation;
pub(crate) mod diagnosis;
mod prune;
mod reason;
mod rivals;
mod rounds;

pub use crate::cause::round::Round;
pub use crate::inputs::Inputs;
pub use crate::size::absorbed::Absorbed;
pub use crate::size::data_value::LookAlikes;
pub use crate::size::estimate::{Estimate, ParameterEstimate};
pub use crate::size::force::Force;
pub use crate::size::limit::Limit;
pub use crate::size::never_exact::NeverExact;
pub use diagnosis::Diagnosis;

use crate::ground::budget::Budgeted;
use crate::ground::establish::establish;
use crate::ground::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::place::whereabouts;
use crate::proof::compare::shown;
use crate::record::measured::Record;
use crate::thresholds::PROMISED;
use conclude::conclude;
use rounds::rounds;

/// Runs a diagnosis within the budget of simulations.
///
/// # Errors
/// Those of the laboratory: no worker is left, or the user stopped the run.
pub async fn diagnose<L: Laboratory>(lab: &mut L, inputs: &Inputs) -> Result<Diagnosis, L::Error> {
    let mut counted = Budgeted::new(lab, &inputs.thresholds.budget);
    let mut diagnosis = within(&mut counted, inputs).await?;
    diagnosis
        .notes
        .extend(counted.ran_out().iter().map(|stage| {
            format!(
                "the stage \"{}\" used up its budget of {} simulations and began no further work",
                stage.name(),
                inputs.thresholds.budget[*stage as usize]
            )
        }));
    diagnosis.ran_out = counted.ran_out().to_vec();
    Ok(diagnosis)
}

/// Runs a diagnosis in a laboratory that enforces the budget.
async fn within<L: Laboratory>(lab: &mut L, inputs: &Inputs) -> Result<Diagnosis, L::Error> {
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
    let mut base = match establish(lab, inputs, split.fitted.clone()).await? {
        Ok(base) => base,
        Err(baseless) => return Ok(Diagnosis::unresolved(baseless.reason())),
    };
    let mut split = split;
    let mut first = Session {
        lab: &mut *lab,
        base: &base,
        inputs,
    };
    let completed = correlation::completed(&mut first).await?;
    let again: Inputs;
    let mut inputs = inputs;
    if let Some((fitted, said)) = completed {
        again = correlation::again(inputs, &fitted, &base.fit);
        inputs = &again;
        split = again.records.first().map_or(split, Record::split);
        base = match establish(lab, inputs, split.fitted.clone()).await? {
            Ok(base) => base,
            Err(baseless) => return Ok(Diagnosis::unresolved(baseless.reason())),
        };
        base.notes.push(said);
    }
    let (base, split) = (base, split);
    let mut session = Session {
        lab,
        base: &base,
        inputs,
    };
    let mut diagnosis = Diagnosis {
        reason: None,
        whereabouts: Some(whereabouts::look(&mut session).await?),
        noise: base.known(),
        preflight: base.preflight.clone(),
        notes: base.notes.clone(),
        before: Some(base.fit.clone()),
        ..Diagnosis::unresolved("")
    };
    if !session.lab.may(Stage::What) {
        let reason = "the budget of the tests is used up: no effect was tested";
        diagnosis.reason = Some(reason.to_owned());
        return Ok(diagnosis);
    }
    let promised = base.fit.search.promised_decrease();
    if promised > PROMISED {
        diagnosis.reason = Some(format!(
            "the recalibration did not converge: one more step is predicted to lower the misfit by {:.0} %, \
             so that tests of effects would respond to calibration error",
            100.0 * promised
        ));
        return Ok(diagnosis);
    }
    let shown = shown(&mut session, &split).await?;
    let after = rounds(&mut session, &shown, &mut diagnosis).await?;
    conclude(&mut session, after, &shown, &mut diagnosis).await?;
    Ok(diagnosis)
}
