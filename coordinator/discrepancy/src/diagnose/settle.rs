//! Continuation of the fit of an answer until it has converged, with its instruments held by their priors
//! alone.
use crate::baseline::recalibrate;
use crate::baseline::session::Session;
use crate::diagnose::remainder::is_converged;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::model::nuisance_parameter::NuisanceParameter;
use crate::thresholds::{AT_BOUND, WITHIN};
use search::least_squares::Termination;

/// Maximum number of times that a fit is continued.
const CONTINUED: usize = 2;

/// Continues the fit of an answer until it has converged. Instruments that were limited to their tolerance
/// because the model without effects needed more, and stand at that limit, are released first.
///
/// # Errors
/// Those of the laboratory.
pub(crate) async fn settle<L: Laboratory>(
    session: &mut Session<'_, L>,
    mut answer: Fit,
) -> Result<Fit, L::Error> {
    if answer.model.added.is_empty() {
        return Ok(answer);
    }
    for _ in 0..CONTINUED {
        let held = session.base.instruments_are_held() && stands_at_limit(&answer);
        let ended = answer.search.ended() == Some(Termination::Converged);
        if !held && ended && is_converged(&answer) {
            break;
        }
        let mut start = answer.point();
        if held {
            start
                .model
                .nuisances
                .iter_mut()
                .for_each(NuisanceParameter::release);
        }
        let mut experiments = session.experiments(Stage::Refit);
        match recalibrate::converge(&mut experiments, start).await? {
            Some(fit) => answer = fit,
            None => break,
        }
    }
    Ok(answer)
}

/// Returns whether an instrument of a fit stands at the limit of its tolerance.
fn stands_at_limit(fit: &Fit) -> bool {
    let mut values = fit.model.nuisance_values(fit.x());
    values.any(|(one, x)| one.farthest <= WITHIN && x.abs() >= (1.0 - AT_BOUND) * WITHIN)
}
