//! Conclusion of a diagnosis: estimates, validation, verdict and its reason.
//!
//! Where the tests lack a reliable basis (assumed noise, a model never compared with a finer one), the
//! effects found are withdrawn from the answer. They remain visible as suspects with size and evidence in
//! nats, and the reason states what is needed to name them. Effects with implausible sizes are treated
//! likewise.
use crate::baseline::session::Session;
use crate::diagnose::claim::{claim, no_answer};
use crate::diagnose::diagnosis::WorkingDiagnosis;
use crate::diagnose::other_starts::{Starts, fit_from_other_starts};
use crate::diagnose::plausibility;
use crate::diagnose::reason::{Rejection, left, reason, remarks};
use crate::diagnose::remainder::remainder;
use crate::diagnose::validate::{
    doubt_of_force, drop_implausible, prove, replace_by_force, validate,
};
use crate::estimate::effect_size::{Estimate, refitted};
use crate::estimate::neighbourhood::Neighbourhood;
use crate::estimate::nuisances::nuisance_estimates;
use crate::estimate::spread::{Spread, coloured};
use crate::hypothesis::round::WorkingRound;
use crate::laboratory::{Laboratory, Stage};
use crate::localisation::parameter_drift::refit::drifts;
use crate::localisation::summary;
use crate::model::fit::Fit;
use crate::validation::compare::ValidationRecord;
use crate::verdict::{Findings, TestValidity, verdict};
use record::metric::Metric;
use record::noise::NoiseSource;
use std::mem;

/// Computes estimates, validation and verdict of a diagnosis; `shown` are the records used for the
/// validation.
pub(crate) async fn conclude<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: Fit,
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut WorkingDiagnosis,
) -> Result<(), L::Error> {
    let (base, inputs) = (session.base, session.inputs);
    let claims = !answer.model.added.is_empty() || diagnosis.generic.is_some();
    let ground = ground(session, claims, diagnosis);
    let Settled {
        after,
        suspect,
        doubt,
    } = settled(session, (answer, ground), shown, diagnosis).await?;
    diagnosis.whiteness = Some([&base.fit, &after].map(|fit| summary::white(base, fit)));
    let mut experiments = session.experiments(Stage::Show);
    diagnosis.drifts = drifts(&mut experiments, &base.fit, inputs.others()).await?;
    if !after.model.added.is_empty() {
        diagnosis.drifts_after = drifts(&mut experiments, &after, inputs.others()).await?;
    }
    let thresholds = &inputs.thresholds;
    let trace_only = is_trace_alone(session, &after, shown, diagnosis).await?;
    let misfit = if trace_only {
        None
    } else if base.explains(&after, thresholds.adequacy) {
        let mut left = diagnosis.remainder.left.iter();
        left.next()
            .map(|left| left.words(&inputs.condition(left.condition)))
    } else {
        Some(left(base, &after))
    };
    let rejection = Rejection {
        names: diagnosis
            .rounds
            .first()
            .is_some_and(|r| r.p_value < thresholds.alpha && r.trace.is_none()),
        suspect,
        doubt,
        left: misfit,
    };
    let seen = diagnosis.localisation.as_ref();
    let maps = !trace_only && seen.is_some_and(|seen| seen.rejects(thresholds.alpha));
    let findings = Findings {
        ground,
        rejected: rejection.names || rejection.left.is_some() || maps,
        added: after.model.added.len(),
        rivals: diagnosis
            .rounds
            .iter()
            .map(|r| r.set.len())
            .max()
            .unwrap_or(0),
        probe_force_wins: diagnosis.generic.is_some(),
    };
    diagnosis.verdict = verdict(&findings);
    diagnosis.reason = reason(ground, diagnosis, &rejection);
    if let Some(instruments) = base.instruments_beyond_tolerance() {
        match &mut diagnosis.reason {
            Some(reason) => reason.extend(["; ", &instruments]),
            None => diagnosis.notes.push(instruments),
        }
    }
    if diagnosis.generic.is_none() {
        diagnosis.notes.extend(rejection.left);
    }
    remarks(inputs, shown, diagnosis);
    let spread = Spread::of(&base.record.metric, &after);
    if let Some(growth) = spread.largest_growth() {
        diagnosis.notes.push(coloured(growth));
    }
    diagnosis.nuisances = nuisance_estimates(&after, &spread);
    let mut experiments = session.experiments(Stage::Show);
    let found = Neighbourhood::around(&mut experiments, &after, &spread).await?;
    diagnosis.neighbourhood = Some(found);
    // what a missing effect leaves is no noise: limits are those beside the answer
    let ratio = (after.misfit() / base.fit.misfit()).sqrt();
    for limit in &mut diagnosis.limits {
        limit.size *= ratio;
    }
    let rounds = diagnosis.rounds.iter();
    diagnosis.sizes = rounds
        .map(|round| sizes(round, &base.record.metric))
        .collect();
    diagnosis.after = Some(after);
    Ok(())
}

/// Returns whether nothing but noise and a trace is left of every record; the diagnosis then says that nothing is
/// left.
async fn is_trace_alone<L: Laboratory>(
    session: &mut Session<'_, L>,
    after: &Fit,
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut WorkingDiagnosis,
) -> Result<bool, L::Error> {
    let traced = diagnosis.rounds.first().and_then(WorkingRound::traced);
    let Some(traced) = traced.filter(|_| after.model.added.is_empty()) else {
        return Ok(false);
    };
    let with = remainder(session, traced, shown, &diagnosis.rows).await?;
    let alone = with.left.is_empty();
    if alone {
        diagnosis.remainder.left.clear();
    }
    Ok(alone)
}

/// Answer after its validation.
struct Settled {
    /// Model of the answer: without effects if none is named.
    after: Fit,
    /// Description of the effects that were found but are not named.
    suspect: Option<String>,
    /// Reason why they are not named, although the basis of the tests is reliable.
    doubt: Option<String>,
}

/// Fits an answer to convergence and validates it; withdraws from the diagnosis what does not hold.
async fn settled<L: Laboratory>(
    session: &mut Session<'_, L>,
    (mut answer, ground): (Fit, TestValidity),
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut WorkingDiagnosis,
) -> Result<Settled, L::Error> {
    let base = session.base;
    let firm = matches!(ground, TestValidity::Valid | TestValidity::NoiseStated);
    let mut doubt = validate(session, &mut answer, shown, diagnosis).await?;
    for starts in Starts::ALL {
        let holds = doubt.is_none()
            && diagnosis.remainder.beyond.is_empty()
            && implausible(session, &answer, diagnosis).is_none();
        if !firm || holds {
            break;
        }
        let other = fit_from_other_starts(session, &answer, &diagnosis.rounds, starts).await?;
        if let Some(other) = other {
            answer = other;
            withdraw_unneeded(&answer, diagnosis);
            doubt = validate(session, &mut answer, shown, diagnosis).await?;
        }
    }
    while firm && let Some(fewer) = drop_implausible(session, &answer, diagnosis).await? {
        answer = fewer;
        doubt = validate(session, &mut answer, shown, diagnosis).await?;
    }
    if firm && let Some(without) = replace_by_force(session, &answer, diagnosis).await? {
        answer = without;
        doubt = validate(session, &mut answer, shown, diagnosis).await?;
    }
    let of_force = doubt_of_force(session, &answer, shown, diagnosis).await?;
    let doubt = doubt.or_else(|| implausible(session, &answer, diagnosis));
    // a force beside effects that are not named has no size of its own
    let beside = doubt.is_some() && !answer.model.added.is_empty();
    let mut suspects = Vec::new();
    if !firm || of_force.is_some() || beside {
        suspects.extend(withhold_force(diagnosis));
    }
    if !firm || doubt.is_some() {
        suspects.extend(withhold_effects(diagnosis));
        // what is not named is not shown as an answer, either
        prove(session, &base.fit, shown, diagnosis).await?;
        answer = base.fit.clone();
    }
    let (own, rows) = match (&diagnosis.generic, &diagnosis.force) {
        (Some(_), Some(force)) => (&force.fit, &force.rows),
        _ => (&answer, &diagnosis.rows),
    };
    let beyond = mem::take(&mut diagnosis.remainder.beyond);
    diagnosis.remainder = remainder(session, own, shown, rows).await?;
    diagnosis.remainder.beyond = beyond;
    Ok(Settled {
        after: answer,
        suspect: (!suspects.is_empty()).then(|| suspects.join(" and ")),
        doubt: doubt.or(of_force).filter(|_| firm),
    })
}

/// Returns the sizes of all effects that were refitted in a round, each from its own refit, named or not.
fn sizes(round: &WorkingRound, metric: &Metric) -> Vec<Estimate> {
    let ids = round.refits.iter().map(|own| &own.id);
    ids.filter_map(|id| refitted(round, id, metric)).collect()
}

/// Returns how reliable the tests are, given the source of the noise level and whether a model was compared
/// with a finer one.
fn ground<L>(session: &Session<'_, L>, claims: bool, diagnosis: &WorkingDiagnosis) -> TestValidity {
    let (base, inputs) = (session.base, session.inputs);
    let checked = base.preflight.is_some() || diagnosis.preflight_after.is_some();
    if claims && !checked {
        TestValidity::DiscretisationUnknown
    } else if base.known() == NoiseSource::Estimated {
        TestValidity::NoiseUnknown
    } else if inputs.considered().all(|effect| effect.generic) {
        TestValidity::NothingConsidered
    } else if base.known() == NoiseSource::Stated {
        TestValidity::NoiseStated
    } else {
        TestValidity::Valid
    }
}

/// Returns the reason why the sizes or the ambiguity sets of an answer are none that can be named, if there is
/// one.
fn implausible<L>(
    session: &Session<'_, L>,
    answer: &Fit,
    diagnosis: &WorkingDiagnosis,
) -> Option<String> {
    let base = session.base;
    let sets = || {
        let mut rounds = diagnosis.rounds.iter();
        rounds.find_map(|round| no_answer(base, round))
    };
    let doubt = plausibility::doubt(&claim(session, answer, &diagnosis.effects));
    doubt.map(|doubt| doubt.reason).or_else(sets)
}

fn suspect(id: &str, nats: f64) -> String {
    format!("{id}, at {nats:.0} nats")
}

/// Withdraws the effects that an answer does not have any more, because its fit in another minimum is likelier
/// without them.
fn withdraw_unneeded(answer: &Fit, diagnosis: &mut WorkingDiagnosis) {
    for round in &mut diagnosis.rounds {
        let Some(id) = round.added.clone() else {
            continue;
        };
        if answer.model.added.iter().all(|own| own.id != id) {
            round.withdraw(format!(
                "{id} is not needed in the likelier minimum that a global search found"
            ));
        }
    }
}

/// Withdraws the added effects from the answer of a diagnosis; returns a description of each.
fn withhold_effects(diagnosis: &mut WorkingDiagnosis) -> Vec<String> {
    let mut suspects = Vec::new();
    for round in &mut diagnosis.rounds {
        let Some(id) = round.added.clone() else {
            continue;
        };
        let own = diagnosis.effects.iter().find(|effect| effect.id == id);
        suspects.push(suspect(&id, own.map_or(f64::NAN, |own| own.ln_evidence)));
        round.withdraw(format!("{id} is the likeliest effect, but it is not named"));
    }
    suspects
}

/// Withdraws the generic force from the answer of a diagnosis; returns a description of it.
fn withhold_force(diagnosis: &mut WorkingDiagnosis) -> Option<String> {
    diagnosis.generic.take()?;
    let force = diagnosis.force.as_ref()?;
    Some(suspect(&format!("a force {}", force.id), force.ln_evidence))
}
