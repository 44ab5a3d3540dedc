//! Conclusion of a diagnosis: estimates, validation, verdict and its reason.
//!
//! Where the tests lack a reliable basis (assumed noise, a model never compared with a finer one), the
//! effects found are withdrawn from the answer. They remain visible as suspects with size and evidence in
//! nats, and the reason states what is needed to name them. Effects with implausible sizes are treated
//! likewise.
use crate::baseline::base::Baseline;
use crate::baseline::session::Session;
use crate::diagnose::claim::{claim, no_answer};
use crate::diagnose::diagnosis::Diagnosis;
use crate::diagnose::plausibility;
use crate::diagnose::reason::{Rejection, left, reason, remarks};
use crate::estimate::effect_size::{Estimate, estimates, refitted};
use crate::estimate::force::ForceEstimate;
use crate::estimate::nuisances::nuisance_estimates;
use crate::estimate::spread::{Spread, coloured};
use crate::hypothesis::round::Round;
use crate::laboratory::{Laboratory, Stage};
use crate::localisation::parameter_drift::refit::drifts;
use crate::localisation::summary;
use crate::model::fit::Fit;
use crate::record::metric::Metric;
use crate::record::noise::NoiseSource;
use crate::validation::compare::{ValidationRecord, compare};
use crate::validation::predictive::{rejection_reason, scores};
use crate::verdict::{Findings, TestValidity, verdict};

/// Computes estimates, validation and verdict of a diagnosis; `shown` are the records used for the
/// validation.
pub(crate) async fn conclude<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: Fit,
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut Diagnosis,
) -> Result<(), L::Error> {
    let (base, inputs) = (session.base, session.inputs);
    let claims = !answer.model.added.is_empty() || diagnosis.generic.is_some();
    let ground = ground(session, claims, diagnosis);
    diagnosis.effects = estimates(&diagnosis.rounds, &answer, &base.record.metric);
    prove(session, &answer, shown, diagnosis).await?;
    let firm = matches!(ground, TestValidity::Valid | TestValidity::NoiseStated);
    let predicted = predict(session, &answer, shown, diagnosis).await?;
    let doubt = if firm {
        predicted.or_else(|| doubt(base, &answer, diagnosis))
    } else {
        None
    };
    let (after, suspect) = if firm && doubt.is_none() {
        (answer, None)
    } else {
        let suspect = withhold(diagnosis, !firm);
        // what is not named is not shown as an answer, either
        prove(session, &base.fit, shown, diagnosis).await?;
        (base.fit.clone(), suspect)
    };
    diagnosis.whiteness = Some([&base.fit, &after].map(|fit| summary::white(base, fit)));
    let mut experiments = session.experiments(Stage::Show);
    diagnosis.drifts = drifts(&mut experiments, &base.fit, inputs.others()).await?;
    if !after.model.added.is_empty() {
        diagnosis.drifts_after = drifts(&mut experiments, &after, inputs.others()).await?;
    }
    let thresholds = &inputs.thresholds;
    let misfit = !base.explains(&after, thresholds.adequacy);
    let rejection = Rejection {
        names: diagnosis
            .rounds
            .first()
            .is_some_and(|r| r.p_value < thresholds.alpha),
        suspect,
        doubt,
        left: misfit.then(|| left(base, &after)),
    };
    let seen = diagnosis.localisation.as_ref();
    let maps = seen.is_some_and(|seen| seen.rejects(thresholds.alpha));
    let findings = Findings {
        ground,
        rejected: rejection.names || misfit || maps,
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
    remarks(inputs, diagnosis);
    let spread = Spread::of(&base.record.metric, &after);
    if let Some(growth) = spread.largest_growth() {
        diagnosis.notes.push(coloured(growth));
    }
    diagnosis.nuisances = nuisance_estimates(&after, &spread);
    // what a missing effect leaves is no noise: limits are those beside the answer
    let ratio = (after.dispersion() / base.fit.dispersion()).sqrt();
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

/// Returns the sizes of all effects that were refitted in a round, each from its own refit, named or not.
fn sizes(round: &Round, metric: &Metric) -> Vec<Estimate> {
    let ids = round.refits.iter().map(|own| &own.id);
    ids.filter_map(|id| refitted(round, id, metric)).collect()
}

/// Returns how reliable the tests are, given the source of the noise level and whether a model was compared
/// with a finer one.
fn ground<L>(session: &Session<'_, L>, claims: bool, diagnosis: &Diagnosis) -> TestValidity {
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

/// Scores an answer on data excluded from the fit against the model without effects, stores the scores in the
/// diagnosis, and returns the reason why the answer is not named if it does not predict. The predictive value
/// of each effect in addition to the others is tested earlier.
async fn predict<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: &Fit,
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut Diagnosis,
) -> Result<Option<String>, L::Error> {
    let (base, thresholds) = (session.base, &session.inputs.thresholds);
    let added = &answer.model.added;
    if added.is_empty() {
        return Ok(None);
    }
    let ids: Vec<&str> = added.iter().map(|own| &*own.id).collect();
    let ids = ids.join(" with ");
    if !session.lab.has_budget(Stage::Show) {
        return Ok(Some(format!(
            "{ids} explains the fitted data, but the budget for validation on other data is used up"
        )));
    }
    let mut experiments = session.experiments(Stage::Show);
    let whole = scores(&mut experiments, shown, [answer, &base.fit]).await?;
    diagnosis.prediction.clone_from(&whole.records);
    let tried = diagnosis.rounds.first().map_or(1, |r| r.candidates.len());
    // a name that what took no part has chosen needs as many times more as it chose from
    let rounds = diagnosis.rounds.iter();
    let kept = rounds.filter(|round| round.added.is_some());
    let chosen: f64 = kept.map(|round| libm::log(round.ranked as f64)).sum();
    let needed = whole.needed(thresholds, added.len(), tried) + chosen;
    Ok(rejection_reason(
        &ids,
        &whole,
        [thresholds.prediction, needed],
        session.inputs,
    ))
}

/// Returns the reason why an answer is not named, if there is one.
fn doubt(base: &Baseline, answer: &Fit, diagnosis: &Diagnosis) -> Option<String> {
    let sets = || {
        let mut rounds = diagnosis.rounds.iter();
        rounds.find_map(|round| no_answer(base, round))
    };
    plausibility::doubt(&claim(answer, &diagnosis.effects)).or_else(sets)
}

/// Withdraws the added effects from the answer of a diagnosis, and the generic force as well if `force_too`;
/// returns a description of what was withdrawn.
fn withhold(diagnosis: &mut Diagnosis, force_too: bool) -> Option<String> {
    let nats = |id: &str, nats: f64| format!("{id}, at {nats:.0} nats");
    let mut suspects = Vec::new();
    for round in &mut diagnosis.rounds {
        let Some(id) = round.added.clone() else {
            continue;
        };
        let own = diagnosis.effects.iter().find(|effect| effect.id == id);
        suspects.push(nats(&id, own.map_or(f64::NAN, |own| own.ln_evidence)));
        round.withdraw(format!("{id} is the likeliest effect, but it is not named"));
    }
    if force_too && diagnosis.generic.take().is_some() {
        let force = diagnosis.force.as_ref();
        let said =
            |force: &ForceEstimate| nats(&format!("a force {}", force.id), force.ln_evidence);
        suspects.extend(force.map(said));
    }
    (!suspects.is_empty()).then(|| suspects.join(" and "))
}

/// Computes the misfit to each record before and after adding effects: for the answer, its best rejected
/// rival and the generic force.
async fn prove<L: Laboratory>(
    session: &mut Session<'_, L>,
    after: &Fit,
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut Diagnosis,
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
    if let Some(force) = &mut diagnosis.force {
        force.rows = compare(&mut experiments, shown, before, &force.fit).await?;
    }
    Ok(())
}
