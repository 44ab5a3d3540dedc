//! Rounds of hypothesis tests: each tests all effects, refits the likeliest, compares them with generic
//! forces, and accepts the best or stops; afterwards unnecessary effects are removed.
use crate::baseline::session::Session;
use crate::baseline::{discretisation_check, recalibrate};
use crate::diagnose::acceptance::accept;
use crate::diagnose::backward_elimination::prune;
use crate::diagnose::diagnosis::WorkingDiagnosis;
use crate::diagnose::rivals::rank;
use crate::estimate::absorbed::absorbed;
use crate::estimate::experiment_design;
use crate::estimate::limit::limits;
use crate::hypothesis::candidate::{self, WorkingCandidate};
use crate::hypothesis::refit::{Refitted, may_compete, refit};
use crate::hypothesis::round::WorkingRound;
use crate::hypothesis::signature::examine;
use crate::hypothesis::valley_search;
use crate::laboratory::{Finding, Laboratory, Stage, Suspect};
use crate::model::fit::Fit;
use crate::validation::compare::ValidationRecord;
use crate::validation::gap_closure::gap;
use protocol::announce::EffectDescriptor;
use record::Record;
use search::least_squares::Termination;

/// Number of rounds of a diagnosis in which the narrow minimum of the misfit is searched.
const LOOKS: usize = 2;
/// Minimum number of candidate effects that are refitted in a round.
const RIVALS: usize = 3;

/// Maximum number of repetitions of the rounds after an effect was removed or replaced.
const AGAIN: usize = 2;

/// Runs rounds until nothing is gained, and returns the model of the answer. After an effect was removed or
/// replaced, effects that were rejected beside it are tested again, so that the order in which effects are
/// found does not matter.
pub(crate) async fn rounds<L: Laboratory>(
    session: &mut Session<'_, L>,
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut WorkingDiagnosis,
) -> Result<Fit, L::Error> {
    let (base, inputs) = (session.base, session.inputs);
    let mut current = base.fit.clone();
    let mut met: Vec<Vec<String>> = Vec::new();
    let mut changed = false;
    for _ in 0..=AGAIN {
        current = forward_selection(session, current, diagnosis).await?;
        let found = ids(&current);
        current = prune(session, current, shown, diagnosis).await?;
        current = rank(session, current, shown, diagnosis).await?;
        let kept = ids(&current);
        changed |= kept != found;
        if kept == found || met.contains(&kept) || !session.lab.has_budget(Stage::Refit) {
            break;
        }
        met.push(kept);
    }
    if changed && !current.model.added.is_empty() && session.lab.has_budget(Stage::Preflight) {
        let mut finer = session.experiments(Stage::Preflight);
        diagnosis.preflight_after =
            discretisation_check::check(&mut finer, &current, &base.fit, &inputs.finer).await?;
    }
    Ok(current)
}

/// Returns the identifiers of the added effects, sorted.
fn ids(fit: &Fit) -> Vec<String> {
    let mut ids: Vec<String> = fit.model.added.iter().map(|own| own.id.clone()).collect();
    ids.sort();
    ids
}

/// Runs rounds from a model until no further effect is accepted, and returns the final model.
async fn forward_selection<L: Laboratory>(
    session: &mut Session<'_, L>,
    mut current: Fit,
    diagnosis: &mut WorkingDiagnosis,
) -> Result<Fit, L::Error> {
    let inputs = session.inputs;
    let (generic, named): (Vec<EffectDescriptor>, Vec<EffectDescriptor>) =
        inputs.considered().partition(|effect| effect.generic);
    let mut in_valley = false;
    while current.model.added.len() < inputs.thresholds.rounds {
        let number = diagnosis.rounds.len();
        if number > 0
            && !(session.lab.has_budget(Stage::Test) && session.lab.has_budget(Stage::Refit))
        {
            break;
        }
        let mut open = named.clone();
        open.retain(|effect| current.model.added.iter().all(|a| a.id != effect.id));
        let mut round = test_effects(session, &current, &open, &generic).await?;
        // the valley does not move far once it is found; a second effect may hide it from the first
        if !in_valley && number < LOOKS {
            in_valley = valley_search::search(session, &current, &mut round).await?;
        }
        if number == 0 {
            let limits = limits(&round, &current, inputs.thresholds.alpha);
            diagnosis.look_alikes =
                experiment_design::weigh(session, &current, &round, &limits).await?;
            diagnosis.limits = limits;
            diagnosis.absorbed = absorbed(&round, &current);
        }
        let next = accept(session, &current, &mut round, diagnosis).await?;
        diagnosis.rounds.push(round);
        let Some(next) = next else { break };
        diagnosis.rounds.extend(next.further_rounds);
        current = converged(session, next.fit).await?;
    }
    Ok(current)
}

/// Fits a model to convergence whose fit ended before: tests of further effects would respond to what it left, and
/// every refit would make up for it.
async fn converged<L: Laboratory>(session: &mut Session<'_, L>, fit: Fit) -> Result<Fit, L::Error> {
    if fit.search.ended() != Some(Termination::Iterations) || !session.lab.has_budget(Stage::Refit)
    {
        return Ok(fit);
    }
    let mut experiments = session.experiments(Stage::Refit);
    let further = recalibrate::converge(&mut experiments, fit.point()).await?;
    let better = further.filter(|further| further.chi_squared() < fit.chi_squared());
    Ok(better.unwrap_or(fit))
}

/// Tests all effects that are not yet in the model, and refits the likeliest.
pub(crate) async fn test_effects<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    named: &[EffectDescriptor],
    generic: &[EffectDescriptor],
) -> Result<WorkingRound, L::Error> {
    let thresholds = &session.inputs.thresholds;
    let mut tests = session.experiments(Stage::Test);
    let suspects = examine(&mut tests, current, named).await?;
    let generics = examine(&mut tests, current, generic).await?;
    session.lab.found(&finding(
        &session.base.record.record,
        current,
        &suspects,
        &[],
    ))?;
    let mut order = candidate::ranked(&suspects);
    // what its own test does not speak for is refitted only to have rivals
    let clear = order.iter().filter(|s| s.p_value() < thresholds.alpha);
    let likely = clear.count().max(RIVALS);
    let rest = order.split_off(likely.min(order.len()));
    // what acts from a level on may do so whatever a test at one size says
    let held: Vec<&str> = order.iter().map(|own| &*own.effect.id).collect();
    let mut bent: Vec<&WorkingCandidate> = suspects
        .iter()
        .filter(|own| !own.rungs.is_empty() && !held.contains(&&*own.effect.id))
        .collect();
    bent.sort_by_key(|own| {
        rest.iter()
            .position(|other| other.effect.id == own.effect.id)
    });
    order.extend(bent);
    // each round has an equal share of what is left for refits
    let more = thresholds.rounds.saturating_sub(current.model.added.len());
    let left = session.lab.left(Stage::Refit);
    let share = left - left / more.max(1) as f64;
    let null = current.log_evidence_of_noise();
    let mut refits = Vec::new();
    for some in order.chunks(thresholds.suspects.max(RIVALS)) {
        let spent = session.lab.left(Stage::Refit) < share;
        if !refits.is_empty() && (spent || !session.lab.has_budget(Stage::Refit)) {
            break;
        }
        let gains = refits
            .iter()
            .map(|refit: &Refitted<Fit>| refit.log_evidence - null);
        let best = gains.fold(0.0, f64::max);
        // half the statistic is the gain of evidence that the linearised model promises; what acts from a level
        // on promises nothing by it
        let promises = |own: &&&WorkingCandidate| {
            !own.rungs.is_empty() || may_compete(0.5 * own.statistic(), best)
        };
        let some: Vec<&WorkingCandidate> = some.iter().filter(promises).copied().collect();
        refits.extend(refit(&mut session.experiments(Stage::Refit), current, &some, best).await?);
    }
    session.lab.found(&finding(
        &session.base.record.record,
        current,
        &suspects,
        &refits,
    ))?;
    Ok(WorkingRound::new(current, suspects, generics, refits))
}

/// Summarises the tests and refits of candidate effects against a model, for display.
fn finding(
    record: &Record,
    current: &Fit,
    suspects: &[WorkingCandidate],
    refits: &[Refitted<Fit>],
) -> Finding {
    let needed = [current.discrepancy().cloned()];
    let null = current.log_evidence_among(&needed);
    let suspect = |own: &&WorkingCandidate| Suspect {
        id: own.effect.id.clone(),
        title: own.effect.title.clone(),
        p_value: own.p_value(),
        gain: refits
            .iter()
            .find(|refit| refit.id == own.effect.id)
            .map(|refit| refit.fit.log_evidence_among(&needed) - null),
    };
    Finding {
        added: ids(current),
        gap: gap(record, &current.curves),
        suspects: candidate::ranked(suspects).iter().map(suspect).collect(),
    }
}
