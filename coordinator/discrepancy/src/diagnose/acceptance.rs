//! Decision whether the likeliest effect of a round is accepted: it is compared with generic forces and
//! checked against a finer model.
use crate::baseline::recheck::{Checked, check_against_finer};
use crate::baseline::session::Session;
use crate::diagnose::diagnosis::WorkingDiagnosis;
use crate::estimate::force::force;
use crate::hypothesis::decide::{decide, decide_joint, needed_beside};
use crate::hypothesis::generic_force::{Challenger, challenge};
use crate::hypothesis::joint_refit::{JointRefit, joint_refits};
use crate::hypothesis::round::WorkingRound;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::thresholds::Thresholds;
use record::metric::Metric;

/// Result of a round whose effects were accepted.
pub(crate) struct Accepted {
    /// Fit with the accepted effects, from which the next round starts.
    pub(crate) fit: Fit,
    /// Copies of the round, one for each further effect that was accepted together with the first.
    pub(crate) further_rounds: Vec<WorkingRound>,
}

/// Returns the next model if the best effects of a round are accepted; otherwise records the reason in the
/// round and the diagnosis.
pub(crate) async fn accept<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    round: &mut WorkingRound,
    diagnosis: &mut WorkingDiagnosis,
) -> Result<Option<Accepted>, L::Error> {
    let (base, thresholds) = (session.base, &session.inputs.thresholds);
    let challenger = challenge(session, current, round).await?;
    let together = likeliest_together(session, current, round, challenger.is_some()).await?;
    if let Some(challenger) = challenger.filter(|own| beats(own, together.as_ref(), thresholds)) {
        let (id, fit) = (&challenger.id, &challenger.fit);
        if let Some(reason) = doubt_by_finer_model(session, current, fit, id, diagnosis).await? {
            round.reason = Some(reason);
        } else {
            let named = base.fit.chi_squared() - current.chi_squared();
            let at = (current, &base.record.metric);
            unlisted(round, challenger, at, named, diagnosis);
        }
        return Ok(None);
    }
    if let Some(both) = together
        && let Some(beside) = decide_joint(round, (&both, current), thresholds)
    {
        let id = both.members.join(" with ");
        let reason = doubt_by_finer_model(session, current, &both.fit, &id, diagnosis).await?;
        if let Some(reason) = reason {
            round.withdraw(reason);
            return Ok(None);
        }
        return Ok(Some(Accepted {
            fit: both.fit,
            further_rounds: beside,
        }));
    }
    let Some(next) = decide(round, current, base, thresholds) else {
        return Ok(None);
    };
    let id = round.added.clone().unwrap_or_default();
    if let Some(reason) = doubt_by_finer_model(session, current, &next, &id, diagnosis).await? {
        round.withdraw(reason);
        return Ok(None);
    }
    Ok(Some(Accepted {
        fit: next,
        further_rounds: Vec::new(),
    }))
}

/// Returns the best combination of several effects, if no single effect leaves only noise or a generic force
/// challenges the best one.
async fn likeliest_together<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    round: &WorkingRound,
    challenged: bool,
) -> Result<Option<JointRefit>, L::Error> {
    let thresholds = &session.inputs.thresholds;
    let (base, adequacy) = (session.base, thresholds.adequacy);
    let most = thresholds.rounds.saturating_sub(current.model.added.len());
    let mut refits = round.refits.iter();
    let single = refits.any(|refit| base.explains(&refit.fit, adequacy));
    if most < 2 || (!challenged && (single || round.refits.is_empty())) {
        return Ok(None);
    }
    if !session.lab.has_budget(Stage::Refit) {
        return Ok(None);
    }
    let mut experiments = session.experiments(Stage::Refit);
    let found = joint_refits(&mut experiments, current, &round.candidates, most).await?;
    let evidence = |own: &JointRefit| own.fit.log_evidence();
    Ok(found
        .into_iter()
        .max_by(|a, b| evidence(a).total_cmp(&evidence(b))))
}

/// Returns whether a generic force explains more than the best combination of effects.
fn beats(force: &Challenger, together: Option<&JointRefit>, thresholds: &Thresholds) -> bool {
    together.is_none_or(|own| force.fit.gain_over(&own.fit) >= thresholds.gain)
}

/// Compares the fit with a new effect with a finer discretisation, stores the result in the diagnosis, and
/// returns the reason for a rejection if the gain of evidence does not exceed the numerical error.
async fn doubt_by_finer_model<L: Laboratory>(
    session: &mut Session<'_, L>,
    before: &Fit,
    after: &Fit,
    id: &str,
    diagnosis: &mut WorkingDiagnosis,
) -> Result<Option<String>, L::Error> {
    let needed = needed_beside(before, session.base, &session.inputs.thresholds);
    let Some(Checked { preflight, gain }) = check_against_finer(session, before, after).await?
    else {
        return Ok(None);
    };
    diagnosis.preflight_after = Some(preflight);
    Ok((gain < needed).then(|| {
        format!(
            "{id} is the likeliest effect, but its gain does not exceed the numerical error: with the change by a \
             finer model counted as noise, {gain:.1} nats remain where {needed:.0} are required"
        )
    }))
}

/// Records a generic force that beats every named effect of this round. If the effects found so far (`named`:
/// their reduction of `chi^2`) explain more than the force, it is only noted, because the remaining residual
/// may come from slightly different laws of those effects.
fn unlisted(
    round: &mut WorkingRound,
    challenger: Challenger,
    (current, metric): (&Fit, &Metric),
    named: f64,
    diagnosis: &mut WorkingDiagnosis,
) {
    let said = format!(
        "a generic force {} explains more of the residual than any named effect",
        challenger.id
    );
    if challenger.removed > named {
        diagnosis.generic = Some(challenger.id.clone());
        diagnosis.force = Some(force(challenger, (current, metric)));
    } else {
        diagnosis.notes.push(said.clone());
    }
    round.reason = Some(said);
}
