//! Continuation of the fit of an answer until it has converged, with instruments that are possible.
use crate::baseline::recalibrate;
use crate::baseline::session::Session;
use crate::diagnose::remainder::{instruments_beyond, is_converged};
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::thresholds::{AT_BOUND, WITHIN};
use search::least_squares::Termination;

/// Maximum number of times that a fit is continued.
const CONTINUED: usize = 2;

/// Fit of an answer that has been continued to convergence.
#[derive(Clone, Debug)]
pub(crate) struct SettledFit {
    /// The fit.
    pub(crate) fit: Fit,
    /// Instruments that would lie far beyond their tolerance if their priors alone held them; the fit holds
    /// them within it.
    pub(crate) beyond: Vec<String>,
}

/// Continues the fit of an answer until it has converged. Instruments that stand at the limit of their tolerance
/// are released, and stay so if the answer needs none of them far beyond it. If it does, something else is
/// missing, which a fit would count as explained if such instruments took it up: they are held.
///
/// # Errors
/// Those of the laboratory.
pub(crate) async fn settle<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: Fit,
) -> Result<SettledFit, L::Error> {
    if answer.model.added.is_empty() {
        let beyond = Vec::new();
        return Ok(SettledFit {
            fit: answer,
            beyond,
        });
    }
    let mut fit = continued(session, answer).await?;
    let mut held = None;
    if stands_at_limit(&fit) {
        let start = fit.point().with_released_instruments();
        let mut experiments = session.experiments(Stage::Refit);
        if let Some(released) = recalibrate::converge(&mut experiments, start).await? {
            held = Some(fit);
            fit = continued(session, released).await?;
        }
    }
    let beyond = instruments_beyond(&fit);
    if beyond.is_empty() {
        return Ok(SettledFit { fit, beyond });
    }
    if held.is_none() {
        let mut experiments = session.experiments(Stage::Refit);
        let start = fit.point().with_held_instruments();
        held = recalibrate::converge(&mut experiments, start).await?;
    }
    let fit = held.unwrap_or(fit);
    Ok(SettledFit { fit, beyond })
}

/// Continues a fit until it has converged, or a limited number of times.
async fn continued<L: Laboratory>(
    session: &mut Session<'_, L>,
    mut fit: Fit,
) -> Result<Fit, L::Error> {
    for _ in 0..CONTINUED {
        if fit.search.ended() == Some(Termination::Converged) && is_converged(&fit) {
            break;
        }
        let mut experiments = session.experiments(Stage::Refit);
        match recalibrate::converge(&mut experiments, fit.point()).await? {
            Some(further) => fit = further,
            None => break,
        }
    }
    Ok(fit)
}

/// Returns whether an instrument of a fit stands at the limit of its tolerance.
fn stands_at_limit(fit: &Fit) -> bool {
    let mut values = fit.model.nuisance_values(fit.x());
    values.any(|(one, x)| one.farthest <= WITHIN && x.abs() >= (1.0 - AT_BOUND) * WITHIN)
}
