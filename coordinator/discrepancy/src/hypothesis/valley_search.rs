//! Search for the narrow minimum of the misfit with the likeliest effects switched on.
//!
//! Refits start where the model without effects was fitted. If that is not the narrow minimum at the true
//! stiffness, even the correct effect leaves a large residual there and wrong effects look as good. The
//! likeliest effects are therefore started from the unknowns fitted with competing effects, then scanned for
//! narrow minima (valleys) of their own; if that is not enough, the likeliest is searched globally from the
//! start. All other effects are refitted from the deepest minimum found, and all are compared again. If the
//! residual is still large, the low orders of the period propose the effects to start with.
use crate::baseline::session::Session;
use crate::baseline::{global_start, narrow_minimum};
use crate::hypothesis::low_orders;
use crate::hypothesis::refit::Refitted;
use crate::hypothesis::round::WorkingRound;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use protocol::announce::EffectDescriptor;
use search::least_squares::LeastSquaresSettings;

/// Number of candidate effects for each of which a narrow minimum of its own is searched.
const LEADERS: usize = 2;
/// Minimum gain of evidence, as a share of the best refit's, for which a narrow minimum of the candidate
/// effect is searched.
const SHARE: f64 = 0.3;
/// Minimum gain of evidence, as a share of the best refit's, for which a candidate effect is refitted from
/// the deepest minimum found: in another minimum it may be another.
const HOPEFUL: f64 = 0.1;
/// Dispersion, as a share of that which indicates a missed narrow minimum, above which fits also start from
/// the unknowns of competing refits and from other stiffness and contact values: too soft a contact leaves
/// such a residual, too.
const LOOSE: f64 = 0.5;
/// Maximum number of successive searches for narrow minima in a round; each starts where the previous one
/// ended.
const DEEPER: usize = 3;

/// Better fit of a candidate effect, with the effect's index among the round's refits.
struct DeeperFit {
    place: usize,
    fit: Fit,
}

/// Searches for other narrow minima while the best refit of a round leaves a large residual; updates the
/// round's refits, their order and the derived values. Returns whether the best refit lies in a narrow
/// minimum afterwards.
pub(crate) async fn search<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    round: &mut WorkingRound,
) -> Result<bool, L::Error> {
    let lost = session.inputs.thresholds.valley;
    let genes = current.model.space.dimension();
    let mut found = Vec::new();
    for place in leaders(round, LOOSE * lost) {
        if !session.lab.has_budget(Stage::Basin) {
            break;
        }
        let fit = &round.refits[place].fit;
        let starts = from_rivals(round, place, genes);
        let other =
            narrow_minimum::race(&mut session.experiments(Stage::Basin), fit, starts).await?;
        found.extend(other.map(|fit| DeeperFit { place, fit }));
    }
    settle(session, current, round, found).await?;
    deeper(session, current, round).await?;
    // from the start, with the likeliest effect where it is now
    if let Some(&place) = leaders(round, lost).first()
        && session.lab.has_budget(Stage::Basin)
    {
        let fit = &round.refits[place].fit;
        let search = (session.inputs.global_search, session.inputs.seed);
        let rest = &fit.x()[genes..];
        let mut experiments = session.experiments(Stage::Basin);
        let starts =
            global_start::global_starts(&mut experiments, &fit.model, rest, search).await?;
        let other = narrow_minimum::race(&mut experiments, fit, starts).await?;
        let found = other
            .map(|fit| DeeperFit { place, fit })
            .into_iter()
            .collect();
        settle(session, current, round, found).await?;
    }
    if round.misfit > lost && session.lab.has_budget(Stage::Basin) {
        let found = from_low_orders(session, current, round).await?;
        if !found.is_empty() {
            settle(session, current, round, found).await?;
            deeper(session, current, round).await?;
        }
    }
    Ok(round.misfit <= lost)
}

/// Searches for narrow minima of the likeliest effects repeatedly, each time from the end of the previous
/// search.
async fn deeper<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    round: &mut WorkingRound,
) -> Result<(), L::Error> {
    for _ in 0..DEEPER {
        let mut found = Vec::new();
        for place in leaders(round, LOOSE * session.inputs.thresholds.valley) {
            if !session.lab.has_budget(Stage::Basin) {
                break;
            }
            let fit = &round.refits[place].fit;
            let other = narrow_minimum::scan(&mut session.experiments(Stage::Basin), fit).await?;
            found.extend(other.map(|fit| DeeperFit { place, fit }));
        }
        if found.is_empty() {
            break;
        }
        settle(session, current, round, found).await?;
    }
    Ok(())
}

/// Returns the effects that best explain the low orders of the period, each fitted in a narrow minimum of its
/// own, if they leave a clearly smaller residual than every refit so far.
async fn from_low_orders<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    round: &mut WorkingRound,
) -> Result<Vec<DeeperFit>, L::Error> {
    let effects: Vec<EffectDescriptor> =
        round.candidates.iter().map(|s| s.effect.clone()).collect();
    let highest = session.inputs.thresholds.orders;
    let mut experiments = session.experiments(Stage::Basin);
    let likeliest = low_orders::likeliest(&mut experiments, current, &effects, highest).await?;
    let fits = experiments
        .fits(likeliest, LeastSquaresSettings::short(3))
        .await?;
    let left = round.refits.iter().map(|refit| refit.fit.chi_squared());
    let least = left.fold(current.chi_squared(), f64::min);
    let mut found = Vec::new();
    for fit in fits.into_iter().flatten() {
        let fit = narrow_minimum::scan(&mut experiments, &fit)
            .await?
            .unwrap_or(fit);
        let Some(effect) = fit.model.added.last() else {
            continue;
        };
        if fit.chi_squared() >= narrow_minimum::BETTER * least {
            continue;
        }
        let id = effect.id.clone();
        let place = round.refits.iter().position(|refit| refit.id == id);
        let place = place.unwrap_or_else(|| {
            round.refits.push(Refitted::new(id, fit.clone()));
            round.refits.len() - 1
        });
        found.push(DeeperFit { place, fit });
    }
    Ok(found)
}

/// Returns the indices of the likeliest refits whose dispersion exceeds a given value.
fn leaders(round: &WorkingRound, bound: f64) -> Vec<usize> {
    let gain = |refit: &Refitted<Fit>| refit.log_evidence - round.null_evidence;
    let best = round.refits.first().map_or(0.0, gain);
    let likely = |refit: &Refitted<Fit>| gain(refit) > 0.0 && gain(refit) > SHARE * best;
    let leads = |refit: &Refitted<Fit>| likely(refit) && refit.fit.misfit() > bound;
    (0..round.refits.len().min(LEADERS))
        .filter(|k| leads(&round.refits[*k]))
        .collect()
}

/// Returns start points that combine the effect of one refit with the unknowns of each other refit.
fn from_rivals(round: &WorkingRound, own: usize, genes: usize) -> Vec<Point> {
    let rivals = round.refits.iter().enumerate().filter(|(k, _)| *k != own);
    rivals
        .map(|(_, rival)| crossed(&rival.fit, &round.refits[own].fit, genes))
        .collect()
}

/// Combines the unknowns of one fit with the model, nuisance parameters and effect parameters of another.
fn crossed(genes_of: &Fit, rest_of: &Fit, genes: usize) -> Point {
    rest_of.point().with_genes(&genes_of.x()[..genes])
}

/// Adopts the better fits found, refits all other promising effects from the best of them, and ranks all
/// refits again.
async fn settle<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    round: &mut WorkingRound,
    found: Vec<DeeperFit>,
) -> Result<(), L::Error> {
    let left = |a: &&Fit, b: &&Fit| a.chi_squared().total_cmp(&b.chi_squared());
    let Some(deepest) = found.iter().map(|found| &found.fit).min_by(left).cloned() else {
        return Ok(());
    };
    for DeeperFit { place, fit } in found {
        replace(&mut round.refits[place], fit);
    }
    let genes = current.model.space.dimension();
    let null = round.null_evidence;
    let gain = |refit: &Refitted<Fit>| refit.log_evidence - null;
    let best = round.refits.iter().map(gain).fold(0.0, f64::max);
    let hopeful = |refit: &&mut Refitted<Fit>| gain(refit) > HOPEFUL * best;
    let mut again: Vec<&mut Refitted<Fit>> = round.refits.iter_mut().filter(hopeful).collect();
    let starts = again
        .iter()
        .map(|refit| crossed(&deepest, &refit.fit, genes))
        .collect();
    let mut experiments = session.experiments(Stage::Refit);
    let fits = experiments
        .fits(starts, LeastSquaresSettings::short(8))
        .await?;
    for (refit, fit) in again.iter_mut().zip(fits) {
        if let Some(fit) = fit {
            replace(refit, fit);
        }
    }
    round.judge(current);
    Ok(())
}

/// Replaces a candidate effect's refit by a fit with a smaller residual.
fn replace(refit: &mut Refitted<Fit>, fit: Fit) {
    if fit.chi_squared() < refit.fit.chi_squared() {
        *refit = Refitted::new(refit.id.clone(), fit);
    }
}
