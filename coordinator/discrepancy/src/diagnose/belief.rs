//! Whether a round's likeliest name is believed: beside the forces without a cause that challenge it, and
//! beside a finer model.
use crate::cause::challenge::{Challenger, challenge};
use crate::cause::decide::decide;
use crate::cause::pair;
use crate::cause::round::Round;
use crate::diagnose::diagnosis::Diagnosis;
use crate::ground::believed::{Checked, believed};
use crate::ground::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::size::force::force;

/// The next model, if the best name of a round is believed; else the round and the diagnosis say why not.
pub(crate) async fn believe<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    round: &mut Round,
    diagnosis: &mut Diagnosis,
) -> Result<Option<Fit>, L::Error> {
    let (base, thresholds) = (session.base, &session.inputs.thresholds);
    if let Some(challenger) = contested(session, current, round).await? {
        let (id, fit) = (&challenger.id, &challenger.fit);
        if let Some(reason) = drowned(session, current, fit, id, diagnosis).await? {
            round.reason = Some(reason);
        } else {
            let named = base.fit.chi_squared() - current.chi_squared();
            unlisted(round, challenger, current, named, diagnosis);
        }
        return Ok(None);
    }
    let Some(next) = decide(round, current, base, thresholds) else {
        return Ok(None);
    };
    let id = round.added.clone().unwrap_or_default();
    if let Some(reason) = drowned(session, current, &next, &id, diagnosis).await? {
        round.withdraw(reason);
        return Ok(None);
    }
    Ok(Some(next))
}

/// Why what a finer model says of an answer is enough to doubt it, if it is; the check is kept.
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
            "{id} is the likeliest, but its gain drowns in the numerical error: with what a finer \
             model changes there as noise, {gain:.1} nats are left and {needed:.0} are needed"
        )
    }))
}

/// A force that beats the best name, and the best two names together.
async fn contested<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    round: &Round,
) -> Result<Option<Challenger>, L::Error> {
    let Some(challenger) = challenge(session, current, round).await? else {
        return Ok(None);
    };
    if !session.lab.may(Stage::Refit) {
        return Ok(Some(challenger));
    }
    // two effects at once may look like a third thing to each of them
    let mut experiments = session.experiments(Stage::Refit);
    let pair = pair::best(&mut experiments, current, &round.suspects).await?;
    let phi = challenger.fit.misfit();
    let margin = session.inputs.thresholds.gain * phi * phi;
    let explained = pair.is_some_and(|evidence| evidence > challenger.log_evidence - margin);
    Ok((!explained).then_some(challenger))
}

/// A force without a cause beats every name of this round. Beside names that explain more than it
/// does it is a remark: what is left there may be the laws of those names, a little otherwise. `named`
/// is by how much they lower `chi^2`.
fn unlisted(
    round: &mut Round,
    challenger: Challenger,
    current: &Fit,
    named: f64,
    diagnosis: &mut Diagnosis,
) {
    let said = format!(
        "a force {} explains more of what is left than any name",
        challenger.id
    );
    if challenger.removed > named {
        diagnosis.generic = Some(challenger.id.clone());
        diagnosis.force = Some(force(challenger, current, round));
    } else {
        diagnosis.notes.push(said.clone());
    }
    round.reason = Some(said);
}
