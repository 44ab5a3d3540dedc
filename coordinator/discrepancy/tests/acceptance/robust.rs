//! Tests of robustness: the library's order and labels and lost runs must not matter; a single cycle and
//! missing channels must be reported.
use crate::strata::{named, planted};
use crate::trial::{MACHINE, Setup, diagnose_usual, diagnosed, line, say};
use crate::truth::{ALL, Truth};
use discrepancy::diagnose::{Diagnosis, Round};
use discrepancy::laboratory::Stage;
use discrepancy::model::FitSummary;
use discrepancy::validation::compare::DataRole;
use discrepancy::verdict::Verdict;
use record::noise::NoiseSource;

/// Returns true machines for the robustness tests: healthy ones, and ones with one planted effect.
fn sample() -> Vec<Truth> {
    let named = named();
    let mut all = vec![Truth::healthy(6000), Truth::healthy(6001)];
    for (k, &at) in [0, 3, 8, 13, 14].iter().enumerate() {
        all.push(planted(Truth::healthy(6010 + k as u64), named[at], 3.0));
    }
    all
}

fn sorted(ids: impl Iterator<Item = String>) -> Vec<String> {
    let mut ids: Vec<String> = ids.collect();
    ids.sort();
    ids
}

/// Acceptance 13: checks that the library's order does not change the verdict.
#[test]
fn a_reversed_library_gives_the_same_verdict() {
    let mut reversed = Setup::default();
    reversed.library.reverse();
    for truth in sample() {
        let (one, (other, _)) = (diagnose_usual(&truth), diagnosed(&truth, &reversed));
        let ids = |d: &Diagnosis| sorted(d.effects.iter().map(|e| e.id.clone()));
        assert_eq!(
            (one.verdict, ids(&one)),
            (other.verdict, ids(&other)),
            "{} | {}",
            line(&one),
            line(&other)
        );
    }
}

/// Acceptance 15: checks that no verdict changes if one run in twenty is lost, and that losses are counted.
#[test]
fn lost_runs_change_no_verdict() {
    let lossy = Setup {
        lost_every: 20,
        ..Setup::default()
    };
    for truth in sample() {
        let (one, (other, lost)) = (diagnose_usual(&truth), diagnosed(&truth, &lossy));
        assert!(lost > 5, "{lost}");
        // where two names are a nat or two apart, lost runs may tip one of them over the margin
        let says_a_name = |d: &Diagnosis| matches!(d.verdict, Verdict::Named | Verdict::Ambiguous);
        assert_eq!(
            says_a_name(&one),
            says_a_name(&other),
            "{} | {}",
            line(&one),
            line(&other)
        );
        let first = |d: &Diagnosis| d.rounds.first().and_then(|r| r.added.clone());
        let set = |d: &Diagnosis| d.rounds.first().map(|r| r.set.clone()).unwrap_or_default();
        let (a, b) = (first(&one), first(&other));
        let agree = a == b
            || a.is_some_and(|a| set(&other).contains(&a))
            || b.is_some_and(|b| set(&one).contains(&b));
        assert!(agree, "{} | {}", line(&one), line(&other));
    }
}

/// Acceptance 14: checks that the same effects are found under permuted labels, so that labels carry no
/// information.
#[test]
fn permuted_labels_fall_to_chance() {
    let named = named();
    let n = named.len();
    let mut setup = Setup::default();
    for effect in &mut setup.library {
        if let Some(k) = named.iter().position(|e| e.id == effect.id) {
            // the wheel turned by five: no name keeps its meaning
            let label = named[(k + 5) % n].id.clone();
            setup.labels.push((label.clone(), effect.id.clone()));
            effect.id = label;
        }
    }
    let (mut by_name, mut by_meaning) = (0, 0);
    for (k, effect) in named.iter().enumerate() {
        let truth = planted(Truth::healthy(7000 + k as u64), effect, 3.0);
        let (answer, _) = diagnosed(&truth, &setup);
        let Some(said) = answer.effects.first() else {
            continue;
        };
        by_name += usize::from(said.id == effect.id);
        let meant = setup.labels.iter().find(|(label, _)| *label == said.id);
        by_meaning += usize::from(meant.is_some_and(|(_, own)| *own == effect.id));
    }
    say(&format!(
        "permuted labels: {by_name} of {n} by name, {by_meaning} by meaning"
    ));
    assert!(by_name <= 2, "{by_name} of {n}: names leak");
    assert!(by_meaning as f64 >= 0.8 * n as f64, "{by_meaning} of {n}");
}

/// Checks diagnoses of a single cycle, which tells nothing about its own noise.
///
/// With stated noise a healthy machine gets no claim, and a defective machine gets a name through its
/// prediction under another condition; without stated noise there is a suspect but no name, however clear the
/// tests are.
#[test]
fn one_cycle_carries_a_name_where_its_noise_is_stated() {
    let setup = |stated: f64| Setup {
        cycles: 1,
        stated,
        ..Setup::default()
    };
    let mut quiet = 0;
    for seed in 0..8 {
        let (answer, _) = diagnosed(&Truth::healthy(8000 + seed), &setup(1.0));
        assert_eq!(answer.noise, NoiseSource::Stated);
        withheld(&answer);
        quiet += usize::from(answer.verdict == Verdict::NothingDetected);
        assert!(answer.rows.iter().all(|row| row.part != DataRole::Cycles));
    }
    assert!(quiet >= 7, "{quiet} of 8");
    let id = &named()[1].id;
    let sick = planted(Truth::healthy(8100), named()[1], 8.0);
    let (strong, _) = diagnosed(&sick, &setup(1.0));
    assert_eq!(strong.verdict, Verdict::Named, "{}", line(&strong));
    assert_eq!(strong.effects[0].id, *id);
    let elsewhere = &strong.prediction[..];
    assert!(
        matches!(elsewhere, [one] if one.part == DataRole::Condition && one.nats > 3.0),
        "{elsewhere:?}"
    );
    let (unknown, _) = diagnosed(&sick, &setup(f64::NAN));
    assert_eq!(unknown.noise, NoiseSource::Estimated);
    withheld(&unknown);
    let reason = unknown.reason.as_deref().unwrap_or_default();
    for said in [id.as_str(), "not known", "record more cycles"] {
        assert!(reason.contains(said), "{reason}");
    }
    let suspects = &unknown.rounds[0].refits;
    let first = suspects.first().map(|r| &r.id);
    assert_eq!(first, Some(id), "{}", line(&unknown));
    // with several cycles the same machine gets its name, too
    let seen = diagnose_usual(&sick);
    assert_eq!(seen.verdict, Verdict::Named, "{}", line(&seen));
}

/// Checks that a data sheet that understates or overstates the noise leads to an unresolved verdict with that
/// reason.
#[test]
fn noise_that_was_wrongly_assumed_is_said() {
    for (k, stated) in [0.2, 4.0].into_iter().enumerate() {
        let setup = Setup {
            cycles: 1,
            stated,
            ..Setup::default()
        };
        let (answer, _) = diagnosed(&Truth::healthy(8150 + k as u64), &setup);
        withheld(&answer);
        assert_eq!(answer.verdict, Verdict::Unresolved, "{}", line(&answer));
        let reason = answer.reason.as_deref().unwrap_or_default();
        assert!(reason.contains("assumed noise"), "{reason}");
    }
}

/// Asserts that a diagnosis makes no claim: no named effect and no unlisted force.
fn withheld(answer: &Diagnosis) {
    let quiet = [Verdict::NothingDetected, Verdict::Unresolved];
    assert!(quiet.contains(&answer.verdict), "{}", line(answer));
    assert!(answer.generic.is_none(), "{}", line(answer));
    let claims = |round: &Round| round.added.is_some() || !round.set.is_empty();
    assert!(!answer.rounds.iter().any(claims), "{}", line(answer));
    assert!(answer.rival.is_none());
    let added = |fit: &FitSummary| !fit.added.is_empty();
    assert!(
        !answer.after.as_ref().is_some_and(added),
        "{}",
        line(answer)
    );
}

/// Checks that each stage may exhaust its budget of simulations: the reason is given, nothing that depends on
/// that stage is claimed, and the stage is listed.
#[test]
fn every_stage_may_run_out_of_simulations() {
    let sick = planted(Truth::healthy(8400), named()[1], 8.0);
    for stage in Stage::ALL {
        let mut setup = Setup::default();
        setup.thresholds.budget[stage as usize] = 0;
        let (answer, _) = diagnosed(&sick, &setup);
        let said = line(&answer);
        // the way into the valley, the map of joints and comparisons beyond the answer's own are looks that an
        // answer can do without
        let optional = [Stage::Basin, Stage::Where, Stage::Refit, Stage::Show].contains(&stage);
        if optional {
            assert_eq!(answer.verdict, Verdict::Named, "{stage:?} {said}");
            let needed = ![Stage::Where, Stage::Basin].contains(&stage);
            let stopped = needed && answer.ran_out.contains(&stage);
            assert_eq!(answer.is_in_part(), stopped, "{stage:?} {said}");
            let reason = answer.reason.as_deref().unwrap_or_default();
            assert_eq!(reason.contains(stage.name()), stopped, "{reason}");
        } else {
            assert_eq!(answer.verdict, Verdict::Unresolved, "{stage:?} {said}");
            let reason = answer.reason.as_deref().unwrap_or_default();
            assert!(!reason.is_empty(), "{stage:?}");
        }
        // what was never asked for did not run out
        let idle = [Stage::Basin, Stage::Show].contains(&stage) && answer.ran_out.is_empty();
        assert!(idle || answer.ran_out.contains(&stage), "{stage:?} {said}");
        if stage == Stage::Where {
            let seen = answer.localisation.as_ref().expect("maps");
            assert!(seen.joints.is_empty(), "{said}");
        }
    }
}

/// Checks that any subset of channels gives limits for all effects, and that none causes a false claim on a
/// healthy machine.
#[test]
fn missing_channels_are_no_disagreement() {
    let some: [&[usize]; 4] = [&ALL[..1], &ALL[..2], &ALL[4..5], &ALL[4..]];
    for (k, channels) in some.into_iter().enumerate() {
        let setup = Setup {
            channels: channels.to_vec(),
            ..Setup::default()
        };
        let (answer, _) = diagnosed(&Truth::healthy(8200 + k as u64), &setup);
        assert_eq!(
            answer.verdict,
            Verdict::NothingDetected,
            "{channels:?} {}",
            line(&answer)
        );
        let named = MACHINE.library().iter().filter(|e| !e.generic);
        let sizes: usize = named.map(|e| discrepancy::model::sizes(e).len()).sum();
        assert_eq!(answer.limits.len(), sizes, "a limit of every size");
    }
}

/// Acceptance 12, on the stand-in: checks that a named effect closes the gap on held-out cycles and under a
/// condition that was not fitted, and that the best rejected rival is reported too.
#[test]
fn a_named_effect_closes_the_gap_where_nothing_was_fitted() {
    let truth = planted(Truth::healthy(8300), named()[2], 6.0);
    let answer = diagnose_usual(&truth);
    assert_eq!(answer.verdict, Verdict::Named, "{}", line(&answer));
    let other = answer
        .rows
        .iter()
        .find(|row| row.condition == 1)
        .expect("a row of the other condition");
    assert_eq!(other.part, DataRole::Condition);
    let interval = other.closed.interval.expect("four cycles");
    assert!(interval[0] > 0.0, "{:?}", other.closed);
    assert!(other.closed.closed > 0.5, "{:?}", other.closed);
    let (rival, rows) = answer.rival.as_ref().expect("a rival");
    assert_ne!(*rival, answer.effects[0].id);
    assert_eq!(rows.len(), answer.rows.len());
}
