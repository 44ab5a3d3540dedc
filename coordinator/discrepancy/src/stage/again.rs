//! A second look at the suspects from the valley that the likeliest of them leads to.
//!
//! Refits begin where the model without effects was fitted. If that is not the valley of the true
//! stiffness, even the right effect leaves much there, and wrong ones stand beside it. So the likeliest
//! look for valleys of their own, all others are refitted from the deepest, and all are judged again.
use crate::bench::Fit;
use crate::evidence::{log_evidence, misfit};
use crate::laboratory::{Laboratory, Stage};
use crate::model::Model;
use crate::rounds::Round;
use crate::settings::Settings;
use crate::stage::establish::Base;
use crate::stage::refit::Refitted;
use crate::stage::valley;
use search::least_squares;

/// Suspects whose own valley is looked for.
const LEADERS: usize = 2;
/// Share of the best refit's gain of evidence from which a suspect is one of them.
const SHARE: f64 = 0.3;
/// The same, from which a suspect is refitted from the deepest valley.
const WORTH: f64 = 0.1;

/// Looks in one round: each begins in the valley where the one before ended.
const DEEPER: usize = 3;

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
    settings: &Settings,
) -> Result<bool, L::Error> {
    for _ in 0..DEEPER {
        if !deeper(lab, base, (current, round), settings).await? {
            break;
        }
    }
    Ok(round.phi <= settings.valley)
}

/// One look: whether another valley was found.
async fn deeper<L: Laboratory>(
    lab: &mut L,
    base: &Base,
    (current, round): (&Fit, &mut Round),
    settings: &Settings,
) -> Result<bool, L::Error> {
    let bench = &base.bench;
    let gain = |refit: &Refitted| refit.log_evidence - round.null_evidence;
    let Some(best) = round.refits.first().map(gain).filter(|gain| *gain > 0.0) else {
        return Ok(false);
    };
    let stuck = |refit: &Refitted| {
        misfit(refit.fit.chi_squared(), bench.metric.len()) > settings.valley
            && gain(refit) > SHARE * best
    };
    let leaders: Vec<usize> = (0..round.refits.len().min(LEADERS))
        .filter(|k| stuck(&round.refits[*k]))
        .collect();
    let mut found: Vec<Fit> = Vec::new();
    for leader in leaders {
        let fit = &round.refits[leader].fit;
        if let Some(other) = valley::enter(lab, (bench, Stage::Refit), fit).await? {
            replace(&mut round.refits[leader], other.clone());
            found.push(other);
        }
    }
    let deepest = found
        .into_iter()
        .min_by(|a, b| a.chi_squared().total_cmp(&b.chi_squared()));
    let Some(deepest) = deepest else {
        return Ok(false);
    };
    let genes = current.model.space.dimension();
    let null = round.null_evidence;
    let mut again: Vec<&mut Refitted> = round
        .refits
        .iter_mut()
        .filter(|refit| refit.log_evidence - null > WORTH * best)
        .collect();
    let starts: Vec<(Model, Vec<f64>)> = again
        .iter()
        .map(|refit| {
            let own = refit.fit.x().iter().skip(genes);
            let x = deepest.x().iter().take(genes).chain(own);
            (refit.fit.model.clone(), x.copied().collect())
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
    Ok(true)
}

/// Takes a fit if it leaves less.
fn replace(refit: &mut Refitted, fit: Fit) {
    if fit.chi_squared() < refit.fit.chi_squared() {
        refit.log_evidence = log_evidence(fit.search.best(), fit.variables());
        refit.fit = fit;
    }
}
