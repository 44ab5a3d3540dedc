//! Effects that are no longer needed beside the others are taken back.
use crate::diagnose::diagnosis::Diagnosis;
use crate::ground::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use search::least_squares::Settings;

/// Takes back, one by one, effects without which the evidence falls by less than it must rise for an
/// effect to be added.
pub(crate) async fn prune<L: Laboratory>(
    session: &mut Session<'_, L>,
    mut current: Fit,
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
        let fits = fits.into_iter().enumerate();
        let best = fits
            .filter_map(|(position, fit)| Some((position, fit?)))
            .max_by(|(_, a), (_, b)| a.log_evidence().total_cmp(&b.log_evidence()));
        let phi = current.misfit();
        let Some((position, fit)) = best else { break };
        if current.log_evidence() - fit.log_evidence() >= gain * phi * phi {
            break;
        }
        let id = &current.model.added[position].id;
        let own = diagnosis
            .rounds
            .iter_mut()
            .filter(|round| round.added.as_ref() == Some(id));
        for round in own {
            round.withdraw(format!("{id} is not needed beside what was added later"));
        }
        current = fit;
    }
    Ok(current)
}
