//! Ambiguity sets: every effect that was refitted in a round is put in the place of the added effect, with
//! the rest of the answer unchanged, and is ranked with it.
//!
//! The rank is the gain of log evidence over the answer, all averaged over the same discrepancies and divided by the
//! same dispersion, plus the predictive score on data excluded from the fit. A rival replaces the added effect only
//! if it passes the same checks: evidence, and comparison with a finer model.
use crate::baseline::recheck::check_against_finer;
use crate::baseline::session::Session;
use crate::diagnose::diagnosis::WorkingDiagnosis;
use crate::hypothesis::candidate::WorkingCandidate;
use crate::hypothesis::decide::needed_beside;
use crate::hypothesis::refit::{Refitted, may_compete};
use crate::hypothesis::round::WorkingRound;
use crate::laboratory::{Laboratory, Stage};
use crate::linear::evidence::ambiguity_set;
use crate::linear::isolability::similarity;
use crate::model::fit::Fit;
use crate::thresholds::AMBIGUITY_MARGIN;
use crate::validation::compare::ValidationRecord;
use crate::validation::predictive::scores;
use search::least_squares::LeastSquaresSettings;

/// Number of rivals with which an effect is compared that was added together with others: those with the most
/// similar signatures.
const ALIKE: usize = 3;

/// Rival effect fitted in place of an added effect: its merit relative to that effect (nats), and its fit.
struct Ranked {
    id: String,
    merit: f64,
    fit: Fit,
}

/// Ranks the rivals of each added effect: the best replaces it, and those whose merit is within [`AMBIGUITY_MARGIN`] of
/// the best form its ambiguity set. Returns the fit of the answer.
pub(crate) async fn rank<L: Laboratory>(
    session: &mut Session<'_, L>,
    mut answer: Fit,
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut WorkingDiagnosis,
) -> Result<Fit, L::Error> {
    for at in 0..diagnosis.rounds.len() {
        let Some(added) = diagnosis.rounds[at].added.clone() else {
            continue;
        };
        let mut places = answer.model.added.iter();
        let Some(position) = places.position(|own| own.id == added) else {
            continue;
        };
        let mut ranked = merits(session, (&answer, position), shown, &diagnosis.rounds[at]).await?;
        // the answer as it is has merit 0, and stands before what has as much
        let merits = std::iter::once(0.0).chain(ranked.iter().map(|own| own.merit));
        let names = std::iter::once(&added).chain(ranked.iter().map(|own| &own.id));
        let (merits, names): (Vec<f64>, Vec<&String>) = merits.zip(names).unzip();
        let places = ambiguity_set(&merits, 1.0, AMBIGUITY_MARGIN);
        let mut set: Vec<String> = places.iter().map(|k| names[*k].clone()).collect();
        let count = merits.len();
        let exchanged = match ranked.first().filter(|own| own.merit > 0.0) {
            Some(own) if is_acceptable(session, (&answer, position), &own.fit).await? => {
                Some(ranked.swap_remove(0))
            }
            _ => None,
        };
        // what stays in its place is in the set, whatever predicts better and is not believed
        if exchanged.is_none() && !set.contains(&added) {
            set.push(added);
        }
        let round = &mut diagnosis.rounds[at];
        round.set = set;
        if let Some(own) = exchanged {
            // chosen twice, chosen from as many pairs
            round.ranked *= count;
            round.added = Some(own.id);
            answer = own.fit;
        }
    }
    Ok(answer)
}

/// Returns the rivals in the place of an added effect with their merits, best first; rivals that cannot be
/// simulated for every record are omitted.
async fn merits<L: Laboratory>(
    session: &mut Session<'_, L>,
    at: (&Fit, usize),
    shown: &[ValidationRecord<'_>],
    round: &WorkingRound,
) -> Result<Vec<Ranked>, L::Error> {
    let (answer, _) = at;
    let rivals = swapped(session, at, round).await?;
    let fits = || rivals.iter().map(|(_, fit)| fit);
    let likeliest = fits().max_by(|a, b| a.log_evidence().total_cmp(&b.log_evidence()));
    let among = answer.discrepancies(likeliest.unwrap_or(answer));
    let dispersion = fits()
        .map(Fit::dispersion)
        .fold(answer.dispersion(), f64::min);
    let of_answer = answer.log_evidence_among(&among);
    let mut ranked = Vec::new();
    for (id, fit) in rivals {
        // without a score only the fitted data tell a rival apart
        let mut predicted = 0.0;
        if session.lab.has_budget(Stage::Show) {
            let mut experiments = session.experiments(Stage::Show);
            let own = scores(&mut experiments, shown, [&fit, answer]).await?;
            if !own.failed.is_empty() {
                continue;
            }
            predicted = own.together.unwrap_or(0.0);
        }
        let gained = (fit.log_evidence_among(&among) - of_answer) / dispersion;
        let merit = gained + predicted;
        if merit.is_finite() {
            ranked.push(Ranked { id, merit, fit });
        }
    }
    ranked.sort_by(|a, b| b.merit.total_cmp(&a.merit));
    Ok(ranked)
}

/// Returns whether a fit, in which a rival replaces an effect of the answer, gains enough evidence over the
/// model without either, also when the change by a finer discretisation counts as noise.
async fn is_acceptable<L: Laboratory>(
    session: &mut Session<'_, L>,
    (answer, position): (&Fit, usize),
    fit: &Fit,
) -> Result<bool, L::Error> {
    let without = session.fit_without(answer, position).await?;
    let Some(without) = without else {
        return Ok(false);
    };
    let needed = needed_beside(&without, session.base, &session.inputs.thresholds);
    let gained = fit.gain_over(&without);
    if gained.is_nan() || gained < needed {
        return Ok(false);
    }
    let checked = check_against_finer(session, &without, fit).await?;
    Ok(checked.is_none_or(|checked| checked.gain >= needed))
}

/// Fits each rival in the place of an added effect, with all other effects of the answer kept.
async fn swapped<L: Laboratory>(
    session: &mut Session<'_, L>,
    (answer, position): (&Fit, usize),
    round: &WorkingRound,
) -> Result<Vec<(String, Fit)>, L::Error> {
    let in_answer = |id: &String| answer.model.added.iter().any(|own| own.id == *id);
    let mut rivals: Vec<_> = round
        .refits
        .iter()
        .filter(|own| !in_answer(&own.id))
        .collect();
    if round.together {
        // alone each may explain nothing
        let tangent = session.base.fit.tangent();
        let of = |id: &str| round.candidates.iter().find(|own| own.effect.id == id);
        let added = of(&answer.model.added[position].id);
        let alike = |other: Option<&WorkingCandidate>| {
            let pair = added.zip(other);
            pair.map_or(0.0, |(a, b)| {
                similarity(&a.signature, &b.signature, &tangent)
            })
        };
        rivals.sort_by(|a, b| alike(of(&b.id)).total_cmp(&alike(of(&a.id))));
        rivals.truncate(ALIKE);
    } else {
        let gain = |own: &Refitted<Fit>| own.log_evidence - round.null_evidence;
        let best = round.refits.iter().map(gain).fold(0.0, f64::max);
        rivals.retain(|own| gain(own) > 0.0 && may_compete(gain(own), best));
    }
    let first =
        answer.model.added.len() == 1 && rivals.iter().all(|own| own.fit.model.added.len() == 1);
    if first {
        // they were refitted just so
        return Ok(rivals
            .into_iter()
            .map(|own| (own.id.clone(), own.fit.clone()))
            .collect());
    }
    let swapped = rivals.into_iter().filter_map(|rival| {
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
    let fits = experiments
        .fits(starts, LeastSquaresSettings::short(5))
        .await?;
    let there = ids.into_iter().zip(fits);
    Ok(there.filter_map(|(id, fit)| Some((id, fit?))).collect())
}
