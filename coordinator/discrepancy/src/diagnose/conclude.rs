//! The end of a diagnosis: estimates, the proof, the verdict and its reason.
//!
//! Where the tests do not stand on firm ground (assumed noise, a model that was never held against a
//! finer one), what was found is taken out of the answer again: it stays visible as a suspect, with its
//! size and its nats, and the reason says what it would take to name it. So does what does not carry.
use crate::cause::decide::widen;
use crate::diagnose::carry;
use crate::diagnose::claim::{claim, no_answer};
use crate::diagnose::diagnosis::Diagnosis;
use crate::diagnose::reason::{Rejection, left, reason, remarks};
use crate::ground::base::Base;
use crate::ground::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::place::wander::refit::wander;
use crate::place::whereabouts;
use crate::proof::compare::{Shown, compare};
use crate::proof::predictive::{Scores, scores};
use crate::record::noise::Known;
use crate::size::estimate::estimates;
use crate::size::force::Force;
use crate::size::never_exact::never_exact;
use crate::verdict::{Findings, Ground, verdict};
use search::least_squares::Settings;

/// Estimates, the proof and the verdict; `shown` is what it is proved on.
pub(crate) async fn conclude<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: Fit,
    shown: &[Shown<'_>],
    diagnosis: &mut Diagnosis,
) -> Result<(), L::Error> {
    let (base, inputs) = (session.base, session.inputs);
    let claims = !answer.model.added.is_empty() || diagnosis.generic.is_some();
    let ground = ground(session, claims, diagnosis);
    if widen(&mut diagnosis.rounds, answer.chi_squared(), base.noise()) {
        diagnosis.notes.push(format!(
            "the answer leaves {:.1} times the noise, so its law is not quite that of the machine, and a \
             law of its rivals need not be either: names that leave not much more stand in one set with it",
            answer.chi_squared() / base.noise()
        ));
    }
    diagnosis.effects = estimates(&diagnosis.rounds, &answer);
    prove(session, &answer, shown, diagnosis).await?;
    let firm = matches!(ground, Ground::Firm);
    let predicted = predict(session, &answer, shown, diagnosis).await?;
    let doubt = if firm {
        predicted.or_else(|| doubt(base, &answer, shown, diagnosis))
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
    diagnosis.whiteness = Some([&base.fit, &after].map(|fit| whereabouts::white(base, fit)));
    let mut experiments = session.experiments(Stage::Show);
    diagnosis.wander = wander(&mut experiments, &base.fit, inputs.others()).await?;
    if !after.model.added.is_empty() {
        diagnosis.wander_after = wander(&mut experiments, &after, inputs.others()).await?;
    }
    let thresholds = &inputs.thresholds;
    let (chi_squared, parameters) = (after.chi_squared(), after.x().len());
    let misfit = !base.is_noise(chi_squared, parameters, thresholds.adequacy);
    let rejection = Rejection {
        names: diagnosis
            .rounds
            .first()
            .is_some_and(|r| r.p_value < thresholds.alpha),
        suspect,
        doubt,
        left: misfit.then(|| left(base, &after)),
    };
    let seen = diagnosis.whereabouts.as_ref();
    let maps = seen.is_some_and(|seen| seen.rejects(thresholds.alpha));
    let findings = Findings {
        ground,
        rejected: rejection.names || misfit || maps || rejection.suspect.is_some(),
        added: after.model.added.len(),
        rivals: diagnosis
            .rounds
            .iter()
            .map(|r| r.set.len())
            .max()
            .unwrap_or(0),
        generic: diagnosis.generic.is_some(),
    };
    diagnosis.verdict = verdict(&findings);
    diagnosis.reason = reason(ground, diagnosis, &rejection);
    if diagnosis.generic.is_none() {
        diagnosis.notes.extend(rejection.left);
    }
    remarks(inputs, diagnosis);
    diagnosis.nuisances = never_exact(&after, after.misfit());
    diagnosis.after = Some(after);
    Ok(())
}

/// What the tests stand on.
fn ground<L>(session: &Session<'_, L>, claims: bool, diagnosis: &Diagnosis) -> Ground {
    let (base, inputs) = (session.base, session.inputs);
    let checked = base.preflight.is_some() || diagnosis.preflight_after.is_some();
    if claims && !checked {
        Ground::Unsound
    } else if base.known == Known::Guessed {
        Ground::NoiseUnknown
    } else if base.known == Known::Stated {
        Ground::NoiseAssumed
    } else if inputs.considered().all(|effect| effect.generic) {
        Ground::NothingConsidered
    } else {
        Ground::Firm
    }
}

/// Scores an answer on what took no part in the fit, each of its effects against the model without it; why it is no
/// name, if it does not predict. The score of the whole answer stays in the diagnosis.
async fn predict<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: &Fit,
    shown: &[Shown<'_>],
    diagnosis: &mut Diagnosis,
) -> Result<Option<String>, L::Error> {
    let (base, needed) = (session.base, session.inputs.thresholds.prediction);
    let added = &answer.model.added;
    if added.is_empty() {
        return Ok(None);
    }
    let mut experiments = session.experiments(Stage::Show);
    let whole = scores(&mut experiments, shown, [answer, &base.fit], base.freedom).await?;
    diagnosis.prediction.clone_from(&whole.records);
    let ids: Vec<&str> = added.iter().map(|own| &*own.id).collect();
    let mut each = vec![(ids.join(" with "), whole)];
    if added.len() > 1 {
        let starts = (0..added.len()).map(|k| answer.point().without(k));
        let mut refits = session.experiments(Stage::Refit);
        let fits = refits.fits(starts.collect(), Settings::short(6)).await?;
        let mut experiments = session.experiments(Stage::Show);
        for (effect, fit) in added.iter().zip(fits) {
            let Some(without) = fit else { continue };
            let own = scores(&mut experiments, shown, [answer, &without], base.freedom).await?;
            each.push((effect.id.clone(), own));
        }
    }
    Ok(each
        .iter()
        .find_map(|(id, scores)| unpredicted(id, scores, needed)))
}

/// Why a score is not enough for a name, if it is not.
fn unpredicted(id: &str, scores: &Scores, needed: f64) -> Option<String> {
    let worst = scores.records.iter().find(|one| one.nats < -needed);
    if let Some(worst) = worst {
        return Some(format!(
            "{id} explains the fitted cycles and predicts {} worse: with it they are {:.1} nats less likely",
            worst.part.words(worst.condition),
            -worst.nats
        ));
    }
    let together = scores.together?;
    // no number is no evidence
    (together.is_nan() || together < needed).then(|| {
        format!(
            "{id} explains the fitted cycles and predicts the others no better: with it what was held out is \
             {together:.1} nats likelier, and {needed:.1} are needed"
        )
    })
}

/// Why an answer is not named, if it is not.
fn doubt(base: &Base, answer: &Fit, shown: &[Shown<'_>], diagnosis: &Diagnosis) -> Option<String> {
    if answer.model.added.is_empty() {
        return None;
    }
    let claim = claim((answer, base), &diagnosis.effects, (shown, &diagnosis.rows));
    let sets = || {
        diagnosis
            .rounds
            .iter()
            .find_map(|round| no_answer(base, round))
    };
    carry::doubt(&claim).or_else(sets)
}

/// Takes what was added, and the force that beats every name if that is doubted as well, out of the
/// answer; says what it was.
fn withhold(diagnosis: &mut Diagnosis, force_too: bool) -> Option<String> {
    let nats = |id: &str, nats: f64| format!("{id}, at {nats:.0} nats");
    let mut suspects = Vec::new();
    for round in &mut diagnosis.rounds {
        let Some(id) = round.added.clone() else {
            continue;
        };
        let own = diagnosis.effects.iter().find(|effect| effect.id == id);
        suspects.push(nats(&id, own.map_or(f64::NAN, |own| own.ln_evidence)));
        round.withdraw(format!("{id} is the likeliest, but no name is given here"));
    }
    if force_too && diagnosis.generic.take().is_some() {
        let force = diagnosis.force.as_ref();
        let said = |force: &Force| nats(&format!("a force {}", force.id), force.ln_evidence);
        suspects.extend(force.map(said));
    }
    (!suspects.is_empty()).then(|| suspects.join(" and "))
}

/// The gap before and after, of the answer, of its best rejected rival and of a force without a cause.
async fn prove<L: Laboratory>(
    session: &mut Session<'_, L>,
    after: &Fit,
    shown: &[Shown<'_>],
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::proof::compare::Portion;
    use crate::proof::predictive::Prediction;

    fn said(cycles: f64, condition: f64, together: Option<f64>) -> Option<String> {
        let one = |(part, nats): (Portion, f64)| Prediction {
            condition: usize::from(part == Portion::Condition),
            part,
            nats,
        };
        let records = [(Portion::Cycles, cycles), (Portion::Condition, condition)].map(one);
        let scores = Scores {
            records: records.into(),
            together,
        };
        unpredicted("slip", &scores, 3.0)
    }

    #[test]
    fn a_name_must_predict_all_together_and_nothing_clearly_worse() {
        assert_eq!(said(5.0, -2.9, Some(3.0)), None);
        let better = said(2.9, 0.0, Some(2.9)).unwrap();
        assert!(
            better.contains("no better") && better.contains("2.9 nats"),
            "{better}"
        );
        let worse = said(90.0, -3.1, Some(80.0)).unwrap();
        assert!(worse.contains("condition 2 of the case worse"), "{worse}");
        assert!(
            said(1.0, 1.0, Some(f64::NAN)).is_some(),
            "no number is no evidence"
        );
        // where nothing was held out there is nothing to predict
        let nothing = Scores::default();
        assert_eq!(unpredicted("slip", &nothing, 3.0), None);
    }
}
