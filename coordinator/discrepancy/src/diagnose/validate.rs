//! Validation of an answer: its fit must be a minimum with instruments that are possible, must predict data
//! excluded from the fit, must not open the gap under another condition, and must not be beaten by a generic
//! force.
use crate::baseline::recalibrate;
use crate::baseline::session::Session;
use crate::diagnose::claim::claim;
use crate::diagnose::diagnosis::WorkingDiagnosis;
use crate::diagnose::plausibility::{self, Doubt, Size};
use crate::diagnose::remainder::{instruments_beyond, is_converged, percent};
use crate::diagnose::settle::{SettledFit, settle};
use crate::estimate::effect_size::estimates;
use crate::estimate::force::force;
use crate::hypothesis::generic_force::in_place;
use crate::hypothesis::round::WorkingRound;
use crate::hypothesis::trace::largest_change;
use crate::inputs::Inputs;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::thresholds::MAJORITY;
use crate::validation::compare::{DataRole, GapRow, ValidationRecord, compare};
use crate::validation::predictive::{Needed, Prediction, rejection_reason, scores};

/// Continues the fit of an answer to convergence, computes its sizes, gaps and predictive scores, stores them in
/// the diagnosis, and returns the reason why the answer is none, if its fit is no minimum, needs instruments that
/// are far off, or does not hold on data excluded from the fit. The predictive value of each effect in addition to
/// the others is tested earlier.
pub(crate) async fn validate<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: &mut Fit,
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut WorkingDiagnosis,
) -> Result<Option<String>, L::Error> {
    let base = session.base;
    let SettledFit { fit, beyond } = settle(session, answer.clone()).await?;
    *answer = fit;
    diagnosis.remainder.beyond = beyond;
    diagnosis.effects = estimates(&diagnosis.rounds, answer, &base.record.metric);
    prove(session, answer, shown, diagnosis).await?;
    let added = &answer.model.added;
    if added.is_empty() {
        return Ok(None);
    }
    let ids: Vec<&str> = added.iter().map(|own| &*own.id).collect();
    let ids = ids.join(" with ");
    let tried = diagnosis.rounds.first().map_or(1, |r| r.candidates.len());
    // a name that what took no part has chosen needs as many times more as it chose from
    let rounds = diagnosis.rounds.iter();
    let kept = rounds.filter(|round| round.added.is_some());
    let chosen: f64 = kept.map(|round| libm::log(round.ranked as f64)).sum();
    let claim = Claim {
        ids: &ids,
        effects: added.len(),
        tried,
        chosen,
    };
    let (records, reason) = prediction(session, [answer, &base.fit], &claim, shown).await?;
    diagnosis.prediction = records;
    let rows = &diagnosis.rows;
    let opened = || opened(&ids, rows, session.inputs);
    let no_fit = no_fit(answer, &ids, (rows, &diagnosis.remainder.beyond));
    let change = largest_change(base, [&base.fit, answer]);
    let trace = || change.and_then(|own| own.trace(&ids, &base.record.record));
    Ok(no_fit.or(reason).or_else(opened).or_else(trace))
}

/// Claim whose predictive score is required.
struct Claim<'a> {
    /// Identifiers of its effects, for messages.
    ids: &'a str,
    /// Number of its effects.
    effects: usize,
    /// Number of candidates from which each was chosen.
    tried: usize,
    /// Nats that the score must have in addition, because the held-out data took part in a choice.
    chosen: f64,
}

/// Scores a model against one without its claim on data excluded from the fit; returns the scores with the
/// reason why the claim does not predict, if it does not.
async fn prediction<L: Laboratory>(
    session: &mut Session<'_, L>,
    [with, without]: [&Fit; 2],
    claim: &Claim<'_>,
    shown: &[ValidationRecord<'_>],
) -> Result<(Vec<Prediction>, Option<String>), L::Error> {
    let inputs = session.inputs;
    let mut experiments = session.experiments(Stage::Show);
    let whole = scores(&mut experiments, shown, [with, without]).await?;
    let needed = Needed {
        chosen: claim.chosen,
        ..Needed::of(&inputs.thresholds, claim.effects, claim.tried)
    };
    let reason = rejection_reason(claim.ids, &whole, needed, inputs);
    Ok((whole.records, reason))
}

/// Returns the reason against a claim that the gap to the record of another condition grows with it, if it
/// does by more than the scatter of the cycles tells.
fn opened(ids: &str, rows: &[GapRow], inputs: &Inputs) -> Option<String> {
    let grows = |row: &&GapRow| {
        let interval = row.closed.interval;
        interval.map_or(row.closed.closed, |[_, upper]| upper) < 0.0
    };
    let mut others = rows.iter().filter(|row| row.part == DataRole::Condition);
    let row = others.find(grows)?;
    Some(format!(
        "{ids} explains the fitted data, but under {} the gap grows by {} with it",
        inputs.condition(row.condition),
        percent(-row.closed.closed)
    ))
}

/// Returns the reason why the fit of an answer is none, if it has not converged, or needs instruments that are
/// far off while it leaves most of the gap to a record.
///
/// Such instruments show that something else is missing, such as the exact law of the effect. They speak against
/// the name only where that something is larger than what is named; otherwise the verdict is in part.
fn no_fit(answer: &Fit, ids: &str, (rows, beyond): (&[GapRow], &[String])) -> Option<String> {
    let least = rows.iter().map(|row| row.closed.closed).reduce(f64::min);
    if let Some(least) = least.filter(|least| *least < MAJORITY)
        && !beyond.is_empty()
    {
        return Some(format!(
            "{ids} explains {} of the gap, and the fit still needs instruments far beyond their tolerance: {}",
            percent(least),
            beyond.join(", ")
        ));
    }
    (!is_converged(answer)).then(|| {
        format!(
            "the fit with {ids} did not converge: one more step is predicted to lower the misfit by {}",
            percent(answer.search.predicted_decrease())
        )
    })
}

/// Removes from an answer of several effects the first that cannot be named beside the others, because of its size or
/// because it explains less than what is missing, and returns the answer without it: what can be named stays. `None`
/// where there is no such effect or no other one.
pub(crate) async fn drop_implausible<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: &Fit,
    diagnosis: &mut WorkingDiagnosis,
) -> Result<Option<Fit>, L::Error> {
    if answer.model.added.len() < 2 {
        return Ok(None);
    }
    let doubt = plausibility::doubt(&claim(session, answer, &diagnosis.effects));
    let doubt = match doubt {
        None => minor(session, answer).await?,
        some => some,
    };
    let Some(doubt) = doubt else {
        return Ok(None);
    };
    let mut added = answer.model.added.iter();
    let Some(position) = added.position(|own| own.id == doubt.effect) else {
        return Ok(None);
    };
    let start = answer.point().without(position);
    let mut experiments = session.experiments(Stage::Refit);
    let Some(fit) = recalibrate::converge(&mut experiments, start).await? else {
        return Ok(None);
    };
    diagnosis.withdraw(&doubt.effect, &doubt.reason);
    Ok(Some(fit))
}

/// Returns the least of several effects of an answer that leaves more than noise, if the effect lowers the misfit by
/// less than that: what is missing beside it is larger, and an effect that resembles it would do as well. The fits that
/// this takes are not optional: they are made without a budget, too.
async fn minor<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: &Fit,
) -> Result<Option<Doubt>, L::Error> {
    let base = session.base;
    let left = answer.chi_squared() - base.noise();
    if left <= 0.0 || base.explains(answer, session.inputs.thresholds.adequacy) {
        return Ok(None);
    }
    let mut least: Option<(f64, &str)> = None;
    for (position, effect) in answer.model.added.iter().enumerate() {
        let Some(without) = session.fit_without(answer, position).await? else {
            continue;
        };
        let explained = (without.chi_squared() - answer.chi_squared()).max(0.0);
        let share = explained / (explained + left);
        if share < least.map_or(MAJORITY, |(share, _)| share) {
            least = Some((share, &effect.id));
        }
    }
    Ok(least.map(|(share, id)| Doubt {
        effect: id.to_owned(),
        reason: format!(
            "{id} explains {} of what is left without it: what is missing beside it is larger",
            percent(share)
        ),
    }))
}

/// Puts the generic force that beats an effect of the answer in the place of that effect, and returns the
/// answer without the effect; `None` where no effect is beaten.
pub(crate) async fn replace_by_force<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: &Fit,
    diagnosis: &mut WorkingDiagnosis,
) -> Result<Option<Fit>, L::Error> {
    if diagnosis.generic.is_some() {
        return Ok(None);
    }
    let sizes = claim(session, answer, &diagnosis.effects);
    for (position, effect) in answer.model.added.iter().enumerate() {
        let own = |round: &&mut WorkingRound| round.added.as_ref() == Some(&effect.id);
        let Some(round) = diagnosis.rounds.iter_mut().find(own) else {
            continue;
        };
        // the size that gives the effect its name comes first
        let size = sizes.iter().find(|size| size.effect == effect.id);
        let vanishes = size.is_some_and(Size::may_be_absent);
        let Some(found) = in_place(session, answer, (position, vanishes), round).await? else {
            continue;
        };
        let id = found.force.id.clone();
        let metric = &session.base.record.metric;
        diagnosis.force = Some(force(found.force, (&found.without, metric)));
        round.withdraw(format!(
            "a generic force {id} in the place of {} explains more of the residual",
            effect.id
        ));
        diagnosis.generic = Some(id);
        return Ok(Some(found.without));
    }
    Ok(None)
}

/// Computes the gaps with the generic force that beats every named effect, and returns the reason why it does
/// not describe a missing effect, if it does not hold on data excluded from the fit.
pub(crate) async fn doubt_of_force<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: &Fit,
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut WorkingDiagnosis,
) -> Result<Option<String>, L::Error> {
    let Some(force) = diagnosis.force.as_mut() else {
        return Ok(None);
    };
    let before = &session.base.fit;
    let mut experiments = session.experiments(Stage::Show);
    force.rows = compare(&mut experiments, shown, before, &force.fit).await?;
    if diagnosis.generic.is_none() {
        return Ok(None);
    }
    let ids = format!("the generic force {}", force.id);
    let claim = Claim {
        ids: &ids,
        effects: 1,
        tried: diagnosis.rounds.first().map_or(1, |r| r.generics.len()),
        chosen: 0.0,
    };
    let fit = force.fit.clone();
    let no_fit = no_fit(&fit, &ids, (&force.rows, &instruments_beyond(&fit)));
    let (records, reason) = prediction(session, [&fit, answer], &claim, shown).await?;
    if answer.model.added.is_empty() {
        diagnosis.prediction = records;
    }
    Ok(no_fit.or(reason))
}

/// Computes the misfit to each record before and after adding effects: for the answer and its best rejected
/// rival.
pub(crate) async fn prove<L: Laboratory>(
    session: &mut Session<'_, L>,
    after: &Fit,
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut WorkingDiagnosis,
) -> Result<(), L::Error> {
    let base = session.base;
    let mut experiments = session.experiments(Stage::Show);
    let before = &base.fit;
    diagnosis.rows = compare(&mut experiments, shown, before, after).await?;
    diagnosis.rival = None;
    let rival = diagnosis.rejected().map(|(_, rival)| rival.clone());
    if let Some(rival) = rival {
        let rows = compare(&mut experiments, shown, before, &rival.fit).await?;
        diagnosis.rival = Some((rival.id, rows));
    }
    Ok(())
}
