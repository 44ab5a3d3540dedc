//! The end of a diagnosis: estimates, the proof, the verdict and its reason.
//!
//! Where the tests do not stand on firm ground (assumed noise, a model that was never held against a
//! finer one), what was found is taken out of the answer again: it stays visible as a suspect, with its
//! size and its nats, and the reason says what it would take to name it.
use crate::bench::Fit;
use crate::decide::widen;
use crate::diagnose::{Diagnosis, Inputs};
use crate::estimate::estimates;
use crate::laboratory::Laboratory;
use crate::locate::whiteness::p_value;
use crate::record::Record;
use crate::stage::establish::Base;
use crate::stage::show;
use crate::stage::wander::wander;
use crate::stage::whereabouts;
use crate::verdict::{Findings, Ground, Verdict, verdict};

/// A numerical error beyond this share of the record's standard error is said aloud.
const FINE_ENOUGH: f64 = 1.0 / 3.0;

/// Estimates, the proof and the verdict.
///
/// # Errors
/// Of the laboratory.
pub(crate) async fn conclude<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
    base: &Base,
    (after, held): (Fit, &Record),
    diagnosis: &mut Diagnosis,
) -> Result<(), L::Error> {
    let claims = !after.model.added.is_empty() || diagnosis.generic.is_some();
    let ground = ground(inputs, base, claims, diagnosis);
    let noise = base.bench.metric.len() as f64;
    if widen(&mut diagnosis.rounds, after.chi_squared(), noise) {
        diagnosis.notes.push(format!(
            "the answer leaves {:.1} times the noise, so its law is not quite that of the machine, and a \
             law of its rivals need not be either: names that leave not much more stand in one set with it",
            after.chi_squared() / noise
        ));
    }
    diagnosis.effects = estimates(&diagnosis.rounds, &after);
    let (after, suspect) = match ground {
        Ground::Firm => (after, None),
        Ground::NoiseAssumed | Ground::NothingConsidered | Ground::Unsound => {
            (base.fit.clone(), withhold(diagnosis))
        }
    };
    prove(lab, inputs, base, (&after, held), diagnosis).await?;
    diagnosis.whiteness = diagnosis.whereabouts.as_ref().map(|seen| {
        let before = p_value(&seen.order, base.freedom);
        if after.model.added.is_empty() {
            return [before; 2];
        }
        let left = whereabouts::orders(&base.bench, &after, base.freedom);
        [before, p_value(&left, base.freedom)]
    });
    let others = inputs.records.get(1..).unwrap_or_default();
    diagnosis.wander = wander(lab, (&base.bench, &base.fit), others).await?;
    if !after.model.added.is_empty() {
        diagnosis.wander_after = wander(lab, (&base.bench, &after), others).await?;
    }
    let alpha = inputs.settings.alpha;
    let names = diagnosis.rounds.first().is_some_and(|r| r.p_value < alpha);
    let misfit = !base.is_noise(
        after.chi_squared(),
        after.x().len(),
        inputs.settings.adequacy,
    );
    let maps = diagnosis
        .whereabouts
        .as_ref()
        .is_some_and(|seen| seen.rejects(alpha));
    let findings = Findings {
        ground,
        rejected: names || misfit || maps || suspect.is_some(),
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
    let left = misfit.then(|| left(base, &after));
    diagnosis.reason = reason(ground, diagnosis, (names, suspect, left.as_deref()));
    let claimed = diagnosis.generic.is_some();
    diagnosis.notes.extend(left.filter(|_| !claimed));
    remarks(inputs, diagnosis);
    diagnosis.after = Some(after);
    Ok(())
}

/// What the tests stand on.
fn ground(inputs: &Inputs, base: &Base, claims: bool, diagnosis: &Diagnosis) -> Ground {
    let checked = base.preflight.is_some() || diagnosis.preflight_after.is_some();
    if claims && !checked {
        Ground::Unsound
    } else if base.assumed {
        Ground::NoiseAssumed
    } else if inputs.considered().all(|effect| effect.generic) {
        Ground::NothingConsidered
    } else {
        Ground::Firm
    }
}

/// Takes what was added, or the force that beats every name, out of the answer; says what it was.
fn withhold(diagnosis: &mut Diagnosis) -> Option<String> {
    let nats = |id: &str, nats: f64| format!("{id}, at {nats:.0} nats");
    let mut suspects = Vec::new();
    for round in &mut diagnosis.rounds {
        let Some(id) = round.added.take() else {
            continue;
        };
        let own = diagnosis.effects.iter().find(|effect| effect.id == id);
        suspects.push(nats(&id, own.map_or(f64::NAN, |own| own.ln_evidence)));
        round.set.clear();
        round.reason = Some(format!("{id} is the likeliest, but no name is given here"));
    }
    if diagnosis.generic.take().is_some() {
        let force = diagnosis.force.as_ref();
        suspects
            .extend(force.map(|force| nats(&format!("a force {}", force.id), force.ln_evidence)));
    }
    (!suspects.is_empty()).then(|| suspects.join(" and "))
}

/// The gap before and after, of the answer, of its best rejected rival and of a force without a cause.
async fn prove<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
    base: &Base,
    (after, held): (&Fit, &Record),
    diagnosis: &mut Diagnosis,
) -> Result<(), L::Error> {
    let mut records: Vec<(&Record, bool)> = vec![(&base.bench.record, true), (held, false)];
    records.extend(inputs.records.iter().skip(1).map(|record| (record, false)));
    records.retain(|(record, _)| !record.cycles.is_empty());
    let refinement = base.bench.refinement;
    diagnosis.rows = show::compare(lab, &records, (&base.fit, after), refinement).await?;
    let rival = diagnosis.rejected().map(|(_, rival)| rival.clone());
    if let Some(rival) = rival {
        let rows = show::compare(lab, &records, (&base.fit, &rival.fit), refinement).await?;
        diagnosis.rival = Some((rival.id, rows));
    }
    if let Some(force) = &mut diagnosis.force {
        force.rows = show::compare(lab, &records, (&base.fit, &force.fit), refinement).await?;
    }
    Ok(())
}

/// What is left and is no noise, in words.
fn left(base: &Base, after: &Fit) -> String {
    let ratio = after.chi_squared() / base.bench.metric.len() as f64;
    if base.assumed && ratio < 1.0 {
        format!("what is left is only {ratio:.2} times the assumed noise, which is no such noise")
    } else if base.assumed {
        format!("what is left is {ratio:.2} times the assumed noise")
    } else {
        format!("what is left is {ratio:.2} times the noise: more than noise, and not explained")
    }
}

/// Why, where the verdict needs it.
fn reason(
    ground: Ground,
    diagnosis: &Diagnosis,
    (names, suspect, left): (bool, Option<String>, Option<&str>),
) -> Option<String> {
    let nothing = diagnosis.verdict == Verdict::NothingDetected;
    if ground == Ground::NothingConsidered && nothing {
        return Some("no effect of the library was considered, so none was looked for".to_owned());
    }
    if diagnosis.verdict != Verdict::Unresolved {
        return None;
    }
    let round = diagnosis.rounds.first().and_then(|r| r.reason.clone());
    let what = match (&suspect, left) {
        (Some(suspect), _) => format!("the likeliest suspect is {suspect}"),
        (None, Some(left)) if !names => {
            round.map_or_else(|| left.to_owned(), |round| format!("{left}; {round}"))
        }
        (None, _) if names => round.unwrap_or_default(),
        (None, _) => "the maps of where simulation and record part show a place that noise alone \
                      would hardly leave"
            .to_owned(),
    };
    Some(match ground {
        Ground::Firm => what,
        Ground::Unsound => format!(
            "no finer model completes its simulation, so how far the discretisation moves the curves \
             is not known; {what}"
        ),
        Ground::NoiseAssumed => format!(
            "the noise is assumed, for one cycle does not show it, and an assumption carries no name; \
             {what}; record more cycles"
        ),
        Ground::NothingConsidered => format!(
            "something is left, and no effect of the library was considered that could name it; {what}"
        ),
    })
}

/// What else should be known: numerical error, effects that were left out.
fn remarks(inputs: &Inputs, diagnosis: &mut Diagnosis) {
    let (of, check) = match (&diagnosis.preflight_after, &diagnosis.preflight) {
        (Some(after), _) => ("the answer", Some(after)),
        (None, before) => ("the recalibrated model", before.as_ref()),
    };
    let ratio = check.map_or(0.0, crate::stage::preflight::Preflight::ratio);
    if ratio > FINE_ENOUGH {
        diagnosis.notes.push(format!(
            "numerical error: a finer model moves {of}'s curves by {ratio:.2} standard errors of the \
             record, where a third is the aim; it counts as noise in every test, but sizes may be off \
             by as much, and shorter cylinders in the case would lower it"
        ));
    }
    let added = diagnosis.rounds.iter().any(|round| round.added.is_some());
    if added && diagnosis.preflight_after.is_none() {
        diagnosis.notes.push(
            "no finer model completes at the answer: its numerical error is unknown".to_owned(),
        );
    }
    if diagnosis.verdict == Verdict::Unlisted && !inputs.settings.without.is_empty() {
        diagnosis.notes.push(format!(
            "these effects of the library were not considered, and may be the cause: {}",
            inputs.settings.without.join(", ")
        ));
    }
}
