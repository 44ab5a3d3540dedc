//! Effects that are no longer needed beside the others, or that close nothing beside them where nothing was
//! fitted, are taken back.
use crate::diagnose::diagnosis::Diagnosis;
use crate::ground::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::proof::compare::{Portion, Row, Shown, compare};
use search::least_squares::Settings;

/// Takes back, one by one, effects without which the evidence falls by less than it must rise for an
/// effect to be added, and those beside which the gap elsewhere may be as wide without them.
pub(crate) async fn prune<L: Laboratory>(
    session: &mut Session<'_, L>,
    mut current: Fit,
    shown: &[Shown<'_>],
    diagnosis: &mut Diagnosis,
) -> Result<Fit, L::Error> {
    let gain = session.inputs.thresholds.gain;
    let elsewhere = shown.iter().filter(|one| one.part != Portion::Fitted);
    let elsewhere: Vec<Shown<'_>> = elsewhere.cloned().collect();
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
        let phi = current.misfit();
        let Some((position, fit)) = fits.first() else {
            break;
        };
        let needless = current.log_evidence() - fit.log_evidence() < gain * phi * phi;
        let found = if needless {
            let reason = "is not needed beside what was added later".to_owned();
            Some((*position, fit.clone(), reason))
        } else {
            let mut experiments = session.experiments(Stage::Show);
            idle(&mut experiments, &elsewhere, &current, fits).await?
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
            round.withdraw(format!("{id} {reason}"));
        }
        current = fit;
    }
    Ok(current)
}

/// The first of several models, each without one effect of an answer, beside which the answer may close
/// nothing on some record that took no part in the fit; the effect's position, that model, and why.
async fn idle<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    elsewhere: &[Shown<'_>],
    answer: &Fit,
    without: Vec<(usize, Fit)>,
) -> Result<Option<(usize, Fit, String)>, L::Error> {
    for (position, fit) in without {
        let rows = compare(experiments, elsewhere, &fit, answer).await?;
        let nothing = |row: &&Row| row.weighed.speaks_against();
        if let Some(row) = rows.iter().find(nothing) {
            let reason = format!(
                "closes {:.0} % of what is left without it on {}, and may close none of it",
                100.0 * row.weighed.closed,
                row.words()
            );
            return Ok(Some((position, fit, reason)));
        }
    }
    Ok(None)
}
