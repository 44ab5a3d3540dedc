//! Names that a record cannot tell apart: whatever was refitted in a round stands in the place of the effect that was
//! added, beside everything else of the answer, and is ranked with it.
//!
//! The rank is the log evidence of the fit over its dispersion, plus the predictive score on what took no part in it;
//! left-out blocks of the fitted record count in the evidence already.
use crate::diagnose::diagnosis::Diagnosis;
use crate::ground::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::proof::compare::{Portion, Shown};
use crate::proof::predictive::scores;
use crate::thresholds::SET;
use search::least_squares::Settings;

/// Share of the gain of evidence of the effect that was added from which a rival is ranked with it: what explains less
/// of the fitted record does not explain enough of another to make up for that.
const RANKED: f64 = 0.5;

/// Ranks the rivals of each added effect: the best takes its place, and those within [`SET`] of the best are its set.
/// Gives the answer.
pub(crate) async fn rank<L: Laboratory>(
    session: &mut Session<'_, L>,
    mut answer: Fit,
    shown: &[Shown<'_>],
    diagnosis: &mut Diagnosis,
) -> Result<Fit, L::Error> {
    for at in 0..diagnosis.rounds.len() {
        let round = &diagnosis.rounds[at];
        let Some(added) = round.added.clone() else {
            continue;
        };
        let mut places = answer.model.added.iter();
        let Some(position) = places.position(|own| own.id == added) else {
            continue;
        };
        let rivals = swapped(session, (&answer, position), diagnosis, at).await?;
        let mut experiments = session.experiments(Stage::Show);
        // merits against the answer as it is
        let mut ranked: Vec<(f64, String, Option<Fit>)> = vec![(0.0, added.clone(), None)];
        for (id, fit) in rivals {
            let own = scores(&mut experiments, shown, [&fit, &answer]).await?;
            if !own.failed.is_empty() {
                continue;
            }
            let held_out = own.records.iter().all(|one| one.part != Portion::LeftOut);
            let predicted = own.together.filter(|_| held_out).unwrap_or(0.0);
            let dispersion = fit.dispersion().min(answer.dispersion());
            let evidence = (fit.log_evidence() - answer.log_evidence()) / dispersion;
            let merit = evidence + predicted;
            if merit.is_finite() {
                ranked.push((merit, id, Some(fit)));
            }
        }
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
        let best = ranked[0].0;
        ranked.retain(|(merit, ..)| best - merit < SET);
        let round = &mut diagnosis.rounds[at];
        round.set = ranked.iter().map(|(_, id, _)| id.clone()).collect();
        if let (_, id, Some(fit)) = ranked.swap_remove(0) {
            round.added = Some(id);
            answer = fit;
        }
    }
    Ok(answer)
}

/// The rivals of an added effect in its place, beside everything else of an answer.
async fn swapped<L: Laboratory>(
    session: &mut Session<'_, L>,
    (answer, position): (&Fit, usize),
    diagnosis: &Diagnosis,
    round: usize,
) -> Result<Vec<(String, Fit)>, L::Error> {
    let round = &diagnosis.rounds[round];
    let in_answer = |id: &String| answer.model.added.iter().any(|own| own.id == *id);
    let best = round.refits.first();
    let gain = |log_evidence: f64| log_evidence - round.null_evidence;
    let enough = best.map_or(0.0, |best| RANKED * gain(best.log_evidence).max(0.0));
    let rivals = round.refits.iter();
    let rivals = rivals.filter(|own| !in_answer(&own.id) && gain(own.log_evidence) > enough);
    let base = &session.base.fit;
    if answer.model.added.len() == 1 && base.model.added.len() + 1 == answer.model.added.len() {
        // in the first round they were refitted just so
        let first = diagnosis.rounds.first().map(|first| first.null_evidence);
        if first.is_some_and(|first| first.total_cmp(&round.null_evidence).is_eq()) {
            return Ok(rivals
                .map(|own| (own.id.clone(), own.fit.clone()))
                .collect());
        }
    }
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
    let there = ids.into_iter().zip(fits);
    Ok(there.filter_map(|(id, fit)| Some((id, fit?))).collect())
}
