//! Decision whether the likeliest effect of a round is accepted: it is compared with generic forces and
//! checked against a finer model.
use crate::cause::challenge::{Challenger, challenge};
use crate::cause::decide::{decide, decide_together};
use crate::cause::round::Round;
use crate::cause::together::{Together, together};
use crate::diagnose::diagnosis::Diagnosis;
use crate::ground::believed::{Checked, believed};
use crate::ground::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::record::metric::Metric;
use crate::size::force::force;
use crate::thresholds::Thresholds;

/// Result of a round whose effects were accepted.
pub(crate) struct Believed {
    /// Fit with the accepted effects, which becomes the next model.
    pub(crate) fit: Fit,
    /// Copies of the round, one for each effect that was added together with its first.
    pub(crate) beside: Vec<Round>,
}

/// Returns the next model if the best effects of a round are accepted; otherwise records the reason in the
/// round and the diagnosis.
pub(crate) async fn believe<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    round: &mut Round,
    diagnosis: &mut Diagnosis,
) -> Result<Option<Believed>, L::Error> {
    let (base, thresholds) = (session.base, &session.inputs.thresholds);
    let challenger = challenge(session, current, round).await?;
    let together = likeliest_together(session, current, round, challenger.is_some()).await?;
    if let Some(challenger) = challenger.filter(|own| beats(own, together.as_ref(), thresholds)) {
        let (id, fit) = (&challenger.id, &challenger.fit);
        if let Some(reason) = drowned(session, current, fit, id, diagnosis).await? {
            round.reason = Some(reason);
        } else {
            let named = base.fit.chi_squared() - current.chi_squared();
            let at = (current, &base.on.metric);
            unlisted(round, challenger, at, named, diagnosis);
        }
        return Ok(None);
    }
    if let Some(both) = together
        && let Some(beside) = decide_together(round, &both, thresholds)
    {
        let id = both.members.join(" with ");
        let reason = drowned(session, current, &both.fit, &id, diagnosis).await?;
        if let Some(reason) = reason {
            round.withdraw(reason);
            return Ok(None);
        }
        return Ok(Some(Believed {
            fit: both.fit,
            beside,
        }));
    }
    let Some(next) = decide(round, current, base, thresholds) else {
        return Ok(None);
    };
    let id = round.added.clone().unwrap_or_default();
    if let Some(reason) = drowned(session, current, &next, &id, diagnosis).await? {
        round.withdraw(reason);
        return Ok(None);
    }
    Ok(Some(Believed {
        fit: next,
        beside: Vec::new(),
    }))
}

/// Returns the best combination of several effects, if no single effect leaves only noise or a generic force
/// challenges the best one.
async fn likeliest_together<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    round: &Round,
    challenged: bool,
) -> Result<Option<Together>, L::Error> {
    let thresholds = &session.inputs.thresholds;
    let (base, adequacy) = (session.base, thresholds.adequacy);
    let most = thresholds.rounds.saturating_sub(current.model.added.len());
    let mut refits = round.refits.iter();
    let single = refits.any(|refit| base.explains(&refit.fit, adequacy));
    if most < 2 || (!challenged && (single || round.refits.is_empty())) {
        return Ok(None);
    }
    if !session.lab.may(Stage::Refit) {
        return Ok(None);
    }
    let mut experiments = session.experiments(Stage::Refit);
    let found = together(&mut experiments, current, &round.suspects, most).await?;
    let evidence = |own: &Together| own.fit.log_evidence();
    Ok(found
        .into_iter()
        .max_by(|a, b| evidence(a).total_cmp(&evidence(b))))
}

/// Returns whether a generic force explains more than the best combination of effects.
fn beats(force: &Challenger, together: Option<&Together>, thresholds: &Thresholds) -> bool {
    let margin = thresholds.gain * force.fit.dispersion();
    together.is_none_or(|own| own.fit.log_evidence() <= force.log_evidence - margin)
}

/// Checks an answer against a finer model, stores the check in the diagnosis, and returns the reason for a
/// rejection if the gain does not exceed the numerical error.
async fn drowned<L: Laboratory>(
    session: &mut Session<'_, L>,
    before: &Fit,
    after: &Fit,
    id: &str,
    diagnosis: &mut Diagnosis,
) -> Result<Option<String>, L::Error> {
    let needed = session.inputs.thresholds.gain;
    let Some(Checked { preflight, gain }) = believed(session, before, after).await? else {
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
    round: &mut Round,
    challenger: Challenger,
    (current, metric): (&Fit, &Metric),
    named: f64,
    diagnosis: &mut Diagnosis,
) {
    let said = format!(
        "a generic force {} explains more of the residual than any named effect",
        challenger.id
    );
    if challenger.removed > named {
        diagnosis.generic = Some(challenger.id.clone());
        diagnosis.force = Some(force(challenger, (current, metric), round));
    } else {
        diagnosis.notes.push(said.clone());
    }
    round.reason = Some(said);
}
