//! Rounds of suspicion: test everything, refit the likeliest, let forces without a cause challenge them,
//! believe the best or stop; at the end, take back what is not needed any more.
use crate::cause::refit::refit;
use crate::cause::round::Round;
use crate::cause::signature::examine;
use crate::cause::{suspect, valley_search};
use crate::diagnose::belief::believe;
use crate::diagnose::diagnosis::Diagnosis;
use crate::diagnose::prune::prune;
use crate::diagnose::rivals::rank;
use crate::ground::preflight;
use crate::ground::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::proof::compare::Shown;
use crate::size::absorbed::absorbed;
use crate::size::data_value;
use crate::size::limit::limits;
use protocol::announce::EffectDescriptor;

/// Rounds in which the valley is looked for.
const LOOKS: usize = 2;
/// Suspects that are refitted in any case.
const RIVALS: usize = 3;

/// Rounds of suspicion until nothing is gained; the model of the answer.
pub(crate) async fn rounds<L: Laboratory>(
    session: &mut Session<'_, L>,
    shown: &[Shown<'_>],
    diagnosis: &mut Diagnosis,
) -> Result<Fit, L::Error> {
    let (base, inputs) = (session.base, session.inputs);
    let (generic, mut open): (Vec<EffectDescriptor>, Vec<EffectDescriptor>) =
        inputs.considered().partition(|effect| effect.generic);
    let mut current = base.fit.clone();
    let mut in_valley = false;
    for number in 0..inputs.thresholds.rounds {
        if number > 0 && !(session.lab.may(Stage::What) && session.lab.may(Stage::Refit)) {
            break;
        }
        open.retain(|effect| current.model.added.iter().all(|a| a.id != effect.id));
        let mut round = suspicion(session, &current, &open, &generic).await?;
        // the valley does not move far once it is found; a second effect may hide it from the first
        if !in_valley && number < LOOKS {
            in_valley = valley_search::search(session, &current, &mut round).await?;
        }
        if number == 0 {
            let limits = limits(&round, &current, inputs.thresholds.alpha);
            diagnosis.look_alikes = data_value::weigh(session, &current, &round, &limits).await?;
            diagnosis.limits = limits;
            diagnosis.absorbed = absorbed(&round, &current);
        }
        let next = believe(session, &current, &mut round, diagnosis).await?;
        diagnosis.rounds.push(round);
        let Some(next) = next else { break };
        diagnosis.rounds.extend(next.beside);
        current = next.fit;
        if current.model.added.len() >= inputs.thresholds.rounds {
            break;
        }
    }
    let added = current.model.added.len();
    let answer = prune(session, current, shown, diagnosis).await?;
    let answer = rank(session, answer, shown, diagnosis).await?;
    if answer.model.added.len() < added {
        let mut finer = session.experiments(Stage::Preflight);
        diagnosis.preflight_after =
            preflight::check(&mut finer, &answer, &base.fit, &inputs.finer).await?;
    }
    Ok(answer)
}

/// Tests everything that is not in the model yet, and refits the suspects.
pub(crate) async fn suspicion<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    named: &[EffectDescriptor],
    generic: &[EffectDescriptor],
) -> Result<Round, L::Error> {
    let thresholds = &session.inputs.thresholds;
    let mut tests = session.experiments(Stage::What);
    let suspects = examine(&mut tests, current, named).await?;
    let generics = examine(&mut tests, current, generic).await?;
    let mut order = suspect::ranked(&suspects);
    // what its own test does not speak for is refitted only to have rivals
    let clear = order.iter().filter(|s| s.p_value() < thresholds.alpha);
    let likely = clear.count().clamp(RIVALS, thresholds.suspects.max(RIVALS));
    order.truncate(likely);
    let refits = refit(&mut session.experiments(Stage::Refit), current, &order).await?;
    Ok(Round::new(current, suspects, generics, refits))
}
