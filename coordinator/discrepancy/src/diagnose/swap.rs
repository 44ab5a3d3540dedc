//! Sets of names that a record cannot tell apart, judged again beside everything that was added since: what
//! explained as much as the added one alone may not do so beside the others.
use crate::diagnose::diagnosis::Diagnosis;
use crate::ground::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use search::least_squares::Settings;

/// Takes from the sets of an answer of several effects whom the record rejects in the place of the added one.
pub(crate) async fn swap<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: &Fit,
    diagnosis: &mut Diagnosis,
) -> Result<(), L::Error> {
    // a set of one round alone was judged with it
    if diagnosis.rounds.len() < 2 {
        return Ok(());
    }
    let phi = answer.misfit();
    let margin = session.inputs.thresholds.gain * phi * phi;
    for round in &mut diagnosis.rounds {
        let Some(added) = round.added.clone() else {
            continue;
        };
        let position = answer.model.added.iter().position(|e| e.id == added);
        let Some(position) = position else { continue };
        let in_answer = |id: &String| answer.model.added.iter().any(|e| e.id == *id);
        let refits = round.refits.iter();
        let rivals = refits.filter(|r| round.set.contains(&r.id) && !in_answer(&r.id));
        let swapped = rivals.filter_map(|rival| {
            let own = rival.fit.model.added.len().checked_sub(1)?;
            let (effect, first) = (&rival.fit.model.added[own], rival.fit.model.first_of(own));
            let start = answer.point().without(position);
            Some((
                rival.id.clone(),
                start.with(effect, &rival.fit.x()[first..]),
            ))
        });
        let (ids, starts): (Vec<String>, Vec<_>) = swapped.unzip();
        let mut experiments = session.experiments(Stage::Refit);
        let fits = experiments.fits(starts, Settings::short(5)).await?;
        for (id, fit) in ids.iter().zip(fits) {
            let evidence = fit.map_or(f64::NEG_INFINITY, |fit| fit.log_evidence());
            if answer.log_evidence() - evidence >= margin {
                round.set.retain(|own| own != id);
            }
        }
        round.set.retain(|own| *own == added || !in_answer(own));
    }
    Ok(())
}
