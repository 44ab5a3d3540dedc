//! Removal of effects that became unnecessary beside later ones, or that do not improve prediction.
use crate::baseline::session::Session;
use crate::diagnose::diagnosis::WorkingDiagnosis;
use crate::hypothesis::decide::needed_beside;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::validation::compare::ValidationRecord;
use crate::validation::predictive::{Needed, rejection_reason, scores};
use search::least_squares::LeastSquaresSettings;

/// Removes, one at a time, effects without which the evidence falls by less than an effect needs beside the others
/// ([`needed_beside`]), and effects that do not improve the prediction of data excluded from the fit.
pub(crate) async fn prune<L: Laboratory>(
    session: &mut Session<'_, L>,
    mut current: Fit,
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut WorkingDiagnosis,
) -> Result<Fit, L::Error> {
    while current.model.added.len() > 1 {
        let added = 0..current.model.added.len();
        let starts = added
            .map(|position| current.point().without(position))
            .collect();
        let mut experiments = session.experiments(Stage::Refit);
        let fits = experiments
            .fits(starts, LeastSquaresSettings::short(6))
            .await?;
        let mut fits: Vec<(usize, Fit)> = fits
            .into_iter()
            .enumerate()
            .filter_map(|(position, fit)| Some((position, fit?)))
            .collect();
        fits.sort_by(|(_, a), (_, b)| b.log_evidence().total_cmp(&a.log_evidence()));
        let Some((position, fit)) = fits.first() else {
            break;
        };
        let needed = needed_beside(fit, session.base, &session.inputs.thresholds);
        let gain = current.gain_over(fit);
        let found = if gain < needed {
            let id = &current.model.added[*position].id;
            let reason = format!(
                "{id} gains {gain:.1} nats beside the others where {needed:.1} are required"
            );
            Some((*position, fit.clone(), reason))
        } else {
            find_unpredictive(session, shown, (&current, fits), diagnosis).await?
        };
        let Some((position, fit, reason)) = found else {
            break;
        };
        diagnosis.withdraw(&current.model.added[position].id, &reason);
        current = fit;
    }
    Ok(current)
}

/// Returns the first of several models, each without one effect of the answer, that predicts as well as the
/// answer: the effect's position, the model, and the reason.
async fn find_unpredictive<L: Laboratory>(
    session: &mut Session<'_, L>,
    shown: &[ValidationRecord<'_>],
    (answer, without): (&Fit, Vec<(usize, Fit)>),
    diagnosis: &WorkingDiagnosis,
) -> Result<Option<(usize, Fit, String)>, L::Error> {
    let inputs = session.inputs;
    let tried = diagnosis.rounds.first().map_or(1, |r| r.candidates.len());
    for (position, fit) in without {
        if !session.lab.has_budget(Stage::Show) {
            break;
        }
        let mut experiments = session.experiments(Stage::Show);
        let own = scores(&mut experiments, shown, [answer, &fit]).await?;
        let needed = Needed::of(&inputs.thresholds, 1, tried);
        let id = &answer.model.added[position].id;
        if let Some(reason) = rejection_reason(id, &own, needed, inputs) {
            return Ok(Some((position, fit, reason)));
        }
    }
    Ok(None)
}
