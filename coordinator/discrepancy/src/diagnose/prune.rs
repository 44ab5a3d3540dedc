//! Effects that are no longer needed beside the others, or that predict nothing beside them, are taken back.
use crate::diagnose::diagnosis::Diagnosis;
use crate::ground::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::proof::compare::Shown;
use crate::proof::predictive::{scores, unpredicted};
use search::least_squares::Settings;

/// Takes back, one by one, effects without which the evidence falls by less than it must rise for an
/// effect to be added, and those that predict what took no part in the fit no better beside the others.
pub(crate) async fn prune<L: Laboratory>(
    session: &mut Session<'_, L>,
    mut current: Fit,
    shown: &[Shown<'_>],
    diagnosis: &mut Diagnosis,
) -> Result<Fit, L::Error> {
    let gain = session.inputs.thresholds.gain;
    while current.model.added.len() > 1 {
        let added = 0..current.model.added.len();
        let starts = added
            .map(|position| current.point().without(position))
            .collect();
        let mut experiments = session.experiments(Stage::Refit);
        let fits = experiments.fits(starts, Settings::short(6)).await?;
        let mut fits: Vec<(usize, Fit)> = fits
            .into_iter()
            .enumerate()
            .filter_map(|(position, fit)| Some((position, fit?)))
            .collect();
        fits.sort_by(|(_, a), (_, b)| b.log_evidence().total_cmp(&a.log_evidence()));
        let Some((position, fit)) = fits.first() else {
            break;
        };
        let lost = (current.log_evidence() - fit.log_evidence()) / current.dispersion();
        let found = if lost < gain {
            let id = &current.model.added[*position].id;
            let reason = format!("{id} is not needed beside what was added later");
            Some((*position, fit.clone(), reason))
        } else {
            idle(session, shown, (&current, fits), diagnosis).await?
        };
        let Some((position, fit, reason)) = found else {
            break;
        };
        let id = &current.model.added[position].id;
        let own = diagnosis
            .rounds
            .iter_mut()
            .filter(|round| round.added.as_ref() == Some(id));
        for round in own {
            round.withdraw(reason.clone());
        }
        current = fit;
    }
    Ok(current)
}

/// The first of several models, each without one effect of an answer, beside which the answer predicts no better; the
/// effect's position, that model, and why.
async fn idle<L: Laboratory>(
    session: &mut Session<'_, L>,
    shown: &[Shown<'_>],
    (answer, without): (&Fit, Vec<(usize, Fit)>),
    diagnosis: &Diagnosis,
) -> Result<Option<(usize, Fit, String)>, L::Error> {
    let inputs = session.inputs;
    let thresholds = &inputs.thresholds;
    let tried = diagnosis.rounds.first().map_or(1, |r| r.suspects.len());
    let mut experiments = session.experiments(Stage::Show);
    for (position, fit) in without {
        let own = scores(&mut experiments, shown, [answer, &fit]).await?;
        let needed = [thresholds.prediction, own.needed(thresholds, 1, tried)];
        let id = &answer.model.added[position].id;
        if let Some(reason) = unpredicted(id, &own, needed, inputs) {
            return Ok(Some((position, fit, reason)));
        }
    }
    Ok(None)
}
