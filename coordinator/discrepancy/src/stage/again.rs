//! A second look at the suspects from the valley that the likeliest of them leads to.
//!
//! Refits begin where the model without effects was fitted. If that is not the valley of the true
//! stiffness, even the right effect leaves much there, and wrong ones stand beside it. So the likeliest
//! try where their rivals arrived, then look for valleys of their own, and at last the likeliest goes the
//! whole way from the start; all others are refitted from the deepest, and all are judged again. If even
//! that is no valley, the low orders of the crank say which effects to begin with.
use crate::bench::Fit;
use crate::diagnose::Inputs;
use crate::evidence::{log_evidence, misfit};
use crate::laboratory::{Laboratory, Stage};
use crate::model::Model;
use crate::rounds::Round;
use crate::stage::establish::Base;
use crate::stage::refit::Refitted;
use crate::stage::{basin, low_orders, valley};
use protocol::announce::EffectDescriptor;
use search::least_squares;

/// Suspects whose own valley is looked for.
const LEADERS: usize = 2;
/// Share of the best refit's gain of evidence from which a suspect is one of them.
const SHARE: f64 = 0.3;
/// The same, from which a suspect is refitted from the deepest valley.
const WORTH: f64 = 0.1;

/// Share of the misfit of a lost valley from which the genes of rivals are tried, and other stiffness and
/// contact: a contact that is too soft leaves as much.
const LOOSE: f64 = 0.5;
/// Looks for valleys in one round: each begins where the one before ended.
const DEEPER: usize = 3;
/// What the low orders suggest is taken if it leaves less than this share of the best refit.
const CLEARLY: f64 = 0.9;

/// Looks again while the best refit of a round leaves much and another valley is found; changes the
/// round's refits, their order and what is derived from them. Says whether the best of them lies in the
/// valley now.
///
/// # Errors
/// Of the laboratory.
pub(crate) async fn look<L: Laboratory>(
    lab: &mut L,
    base: &Base,
    (current, round): (&Fit, &mut Round),
    inputs: &Inputs,
) -> Result<bool, L::Error> {
    let (bench, settings) = (&base.bench, &inputs.settings);
    let genes = current.model.space.dimension();
    let mut found = Vec::new();
    for leader in leaders(round, bench.metric.len(), LOOSE * settings.valley) {
        let fit = &round.refits[leader].fit;
        let starts = from_rivals(round, leader, genes);
        if let Some(other) = valley::follow(lab, (bench, Stage::Refit), fit, starts).await? {
            found.push((leader, other));
        }
    }
    settle(lab, base, (current, round), found).await?;
    deeper(lab, base, (current, round), settings.valley).await?;
    // from the start, with the likeliest effect where it is now
    if let Some(&leader) = leaders(round, bench.metric.len(), settings.valley).first() {
        let fit = &round.refits[leader].fit;
        let (model, rest) = (&fit.model, &fit.x()[genes..]);
        let way = (bench, Stage::Refit);
        let starts = basin::enter(lab, way, (model, rest), inputs.seed).await?;
        let starts = starts.into_iter().map(|x| (model.clone(), x)).collect();
        let found = valley::follow(lab, way, fit, starts).await?;
        let found = found.map(|other| (leader, other)).into_iter().collect();
        settle(lab, base, (current, round), found).await?;
    }
    if round.phi > settings.valley {
        let found = from_low_orders(lab, base, (current, round)).await?;
        if !found.is_empty() {
            settle(lab, base, (current, round), found).await?;
            deeper(lab, base, (current, round), settings.valley).await?;
        }
    }
    Ok(round.phi <= settings.valley)
}

/// Valleys of the likeliest, each look from where the one before ended.
async fn deeper<L: Laboratory>(
    lab: &mut L,
    base: &Base,
    (current, round): (&Fit, &mut Round),
    valley: f64,
) -> Result<(), L::Error> {
    let bench = &base.bench;
    for _ in 0..DEEPER {
        let mut found = Vec::new();
        for leader in leaders(round, bench.metric.len(), LOOSE * valley) {
            let fit = &round.refits[leader].fit;
            if let Some(other) = valley::enter(lab, (bench, Stage::Refit), fit).await? {
                found.push((leader, other));
            }
        }
        if found.is_empty() {
            break;
        }
        settle(lab, base, (current, round), found).await?;
    }
    Ok(())
}

/// What the low orders hold for likeliest, in valleys of its own: those that leave clearly less than every
/// refit so far, with their places among the round's refits.
async fn from_low_orders<L: Laboratory>(
    lab: &mut L,
    base: &Base,
    (current, round): (&Fit, &mut Round),
) -> Result<Vec<(usize, Fit)>, L::Error> {
    let (bench, way) = (&base.bench, (&base.bench, Stage::Refit));
    let effects: Vec<EffectDescriptor> = round.suspects.iter().map(|s| s.effect.clone()).collect();
    let likeliest = low_orders::likeliest(lab, bench, current, &effects).await?;
    let short = least_squares::Settings {
        iterations: 3,
        ..least_squares::Settings::default()
    };
    let fits = bench.fit(lab, Stage::Refit, likeliest, short).await?;
    let left = |refit: &Refitted| refit.fit.chi_squared();
    let least = round.refits.iter().map(left);
    let least = least.fold(current.chi_squared(), f64::min);
    let mut found = Vec::new();
    for fit in fits.into_iter().flatten() {
        let fit = valley::enter(lab, way, &fit).await?.unwrap_or(fit);
        let Some(effect) = fit.model.added.last() else {
            continue;
        };
        if fit.chi_squared() >= CLEARLY * least {
            continue;
        }
        let id = effect.id.clone();
        let place = round.refits.iter().position(|refit| refit.id == id);
        let place = place.unwrap_or_else(|| {
            round.refits.push(Refitted {
                id,
                log_evidence: log_evidence(fit.search.best(), fit.variables()),
                fit: fit.clone(),
            });
            round.refits.len() - 1
        });
        found.push((place, fit));
    }
    Ok(found)
}

/// Places of the likeliest refits that leave more than so much.
fn leaders(round: &Round, n: usize, left: f64) -> Vec<usize> {
    let gain = |refit: &Refitted| refit.log_evidence - round.null_evidence;
    let best = round.refits.first().map_or(0.0, gain);
    let likely = |refit: &Refitted| gain(refit) > 0.0 && gain(refit) > SHARE * best;
    let leads = |refit: &Refitted| likely(refit) && misfit(refit.fit.chi_squared(), n) > left;
    (0..round.refits.len().min(LEADERS))
        .filter(|k| leads(&round.refits[*k]))
        .collect()
}

/// A suspect's own effect with the genes of each other.
fn from_rivals(round: &Round, own: usize, genes: usize) -> Vec<(Model, Vec<f64>)> {
    let fit = &round.refits[own].fit;
    let rivals = round.refits.iter().enumerate().filter(|(k, _)| *k != own);
    rivals
        .map(|(_, rival)| (fit.model.clone(), crossed(&rival.fit, fit, genes)))
        .collect()
}

/// The genes of one fit with everything else of another.
fn crossed(genes_of: &Fit, rest_of: &Fit, genes: usize) -> Vec<f64> {
    let rest = rest_of.x().iter().skip(genes);
    genes_of
        .x()
        .iter()
        .take(genes)
        .chain(rest)
        .copied()
        .collect()
}

/// Takes what was found, refits all others that are worth it from the deepest of it, and judges again.
async fn settle<L: Laboratory>(
    lab: &mut L,
    base: &Base,
    (current, round): (&Fit, &mut Round),
    found: Vec<(usize, Fit)>,
) -> Result<(), L::Error> {
    let bench = &base.bench;
    let deepest = found
        .iter()
        .map(|(_, fit)| fit)
        .min_by(|a, b| a.chi_squared().total_cmp(&b.chi_squared()))
        .cloned();
    let Some(deepest) = deepest else {
        return Ok(());
    };
    for (leader, fit) in found {
        replace(&mut round.refits[leader], fit);
    }
    let genes = current.model.space.dimension();
    let null = round.null_evidence;
    let gain = |refit: &Refitted| refit.log_evidence - null;
    let best = round.refits.iter().map(gain).fold(0.0, f64::max);
    let mut again: Vec<&mut Refitted> = round
        .refits
        .iter_mut()
        .filter(|refit| gain(refit) > WORTH * best)
        .collect();
    let starts: Vec<(Model, Vec<f64>)> = again
        .iter()
        .map(|refit| {
            (
                refit.fit.model.clone(),
                crossed(&deepest, &refit.fit, genes),
            )
        })
        .collect();
    let how = least_squares::Settings {
        iterations: 8,
        ..least_squares::Settings::default()
    };
    let fits = bench.fit(lab, Stage::Refit, starts, how).await?;
    for (refit, fit) in again.iter_mut().zip(fits) {
        if let Some(fit) = fit {
            replace(refit, fit);
        }
    }
    round.judge(current, bench.metric.len());
    Ok(())
}

/// Takes a fit if it leaves less.
fn replace(refit: &mut Refitted, fit: Fit) {
    if fit.chi_squared() < refit.fit.chi_squared() {
        refit.log_evidence = log_evidence(fit.search.best(), fit.variables());
        refit.fit = fit;
    }
}
