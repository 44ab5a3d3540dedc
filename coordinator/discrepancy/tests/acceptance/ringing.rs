//! Tests with records without a period: several cycles or one log, noise that is measured, stated or unknown,
//! drifting sensors, effects with a threshold level, and instrument errors.
use crate::by_curves::ByCurves;
use crate::by_sample::{SAMPLES, SIZES, record, times};
use crate::case::{effect, size};
use crate::trial::{diagnoses, now, say};
use discrepancy::diagnose::{Diagnosis, Inputs, diagnose};
use discrepancy::thresholds::Thresholds;
use discrepancy::validation::compare::DataRole;
use discrepancy::verdict::Verdict;
use protocol::announce::{EffectDescriptor, Place, Sign};
use protocol::case::{Offset, Scale, Unknown};
use protocol::job::{Individual, Numerics, SimulateSpec};
use record::{Acts, Curves, Nuisance, Record};
use search::random::{Phase, Streams};
use search::space::Space;

/// True frequency and damping of the oscillation, in decades from the start values.
const TRUTH: [f64; 2] = [0.03, -0.1];

/// Returns the deflection and the force of a decaying oscillation with effects.
fn curves(genes: &[f64], effects: &[(&str, f64)]) -> Curves {
    let amount = |id: &str| {
        let own = effects.iter().find(|(name, _)| *name == id);
        own.map_or(0.0, |(_, amount)| *amount)
    };
    let (frequency, softening, damping) = (genes[0], genes[1], genes[2]);
    let at = |t: f64| {
        let t = t - amount("late");
        let hard = amount("hardening");
        let fade = (-damping * t).exp();
        // a hardening spring rings faster while it swings far
        let phase = frequency * t + hard * (1.0 - fade * fade) + softening * fade * fade.sqrt();
        // a stop from a level on, and a gauge whose factor is off
        let level = effects.iter().find(|(name, _)| *name == "stop");
        let level = level.map_or(f64::INFINITY, |(_, level)| *level);
        let gain = 1.0 + amount("gain");
        (
            (fade * phase.cos()).clamp(-level, level),
            gain * 8.0 * fade * phase.cos() * (1.0 + 0.5 * hard * fade),
        )
    };
    let drift = |t: f64| amount("drift") * (t - 2.5);
    let both: Vec<(f64, f64)> = times()
        .iter()
        .map(|t| {
            let (deflection, force) = at(*t);
            (deflection + drift(*t), force)
        })
        .collect();
    let both = both.into_iter();
    let (deflection, force): (Vec<f64>, Vec<f64>) = both.unzip();
    vec![deflection, force]
}

fn ringing(spec: &SimulateSpec) -> Curves {
    let Individual { genes, effects, .. } = &spec.individual;
    let effects: Vec<(&str, f64)> = effects
        .iter()
        .map(|e| (e.id.as_str(), e.parameters[0].1))
        .collect();
    curves(genes, &effects)
}

fn library() -> Vec<EffectDescriptor> {
    let own = |id: &str, typical: f64, sign: Sign| {
        effect(
            id,
            "spring",
            Place::Dynamics,
            vec![size("amount", "1", typical, sign)],
        )
    };
    vec![
        own("late", 0.01, Sign::Either),
        own("hardening", 0.2, Sign::Positive),
        own("drift", 0.05, Sign::Either),
        stop(),
    ]
}

/// Returns the effect `stop`, which limits the deflection from a level on; its absent level is far out, and
/// its usual level is still above the deflection, without influence.
fn stop() -> EffectDescriptor {
    let mut stop = effect(
        "stop",
        "stop",
        Place::Dynamics,
        vec![size("level", "1", 1.5, Sign::Either)],
    );
    let level = &mut stop.parameters[0];
    (level.absent, level.typical, level.scale) = (2.0, 1.5, 0.5);
    (level.lower, level.upper) = (0.02, 2.0);
    stop
}

/// Returns the unknowns: frequency, damping, and a detuning (`softening`) that is absent.
fn unknowns() -> Vec<Unknown> {
    let searched = |name: &str, value: f64| {
        let bounds = [0.1 * value, 10.0 * value];
        Unknown::new(name, "1/s", Scale::Logarithmic, value, bounds)
    };
    let mut detuning = Unknown::new("softening", "1", Scale::Linear, 0.0, [0.0, 2.0]);
    detuning.absent = Some(0.0);
    vec![
        searched("frequency", 9.0),
        detuning,
        searched("damping", 0.4),
    ]
}

fn space() -> Space {
    Space::new(&unknowns()).expect("positive and ordered")
}

/// Returns a record of the true oscillation with the given hidden effects.
fn hidden(effects: &[(&str, f64)], cycles: usize, stated: bool) -> Record {
    record(
        77,
        cycles,
        &curves(&space().values(&TRUTH), effects),
        stated,
    )
}

/// Diagnoses records, starting near the truth.
fn diagnosed(records: Vec<Record>) -> Diagnosis {
    diagnosed_without(records, &[])
}

/// Diagnoses records with some effects of the library disabled.
fn diagnosed_without(records: Vec<Record>, without: &[&str]) -> Diagnosis {
    let inputs = Inputs {
        conditions: Vec::new(),
        differentiates: true,
        differences: false,
        space: space(),
        unknowns: unknowns(),
        records,
        library: library(),
        start: Some(vec![TRUTH[0] + 0.004, TRUTH[1] - 0.02]),
        families: None,
        usual: Numerics::FROM_CASE,
        finer: vec![Numerics::FROM_CASE],
        global_search: "quick",
        seed: 1,
        thresholds: Thresholds {
            draws: 100,
            without: without.iter().map(|id| (*id).to_owned()).collect(),
            ..Thresholds::default()
        },
    };
    now(diagnose(&mut ByCurves(|spec| Some(ringing(spec))), &inputs))
}

/// Checks the whole pipeline on records without a period: a healthy record gets no claim, each effect gets
/// its name and size, and a single cycle suffices for a name if its noise is stated.
#[test]
fn what_is_hidden_in_a_record_without_a_period_gets_its_name() {
    let healthy = diagnosed(vec![hidden(&[], 8, false)]);
    let said = crate::trial::line(&healthy);
    assert_eq!(healthy.verdict, Verdict::NothingDetected, "{said}");
    for (id, amount) in [("late", 0.01), ("hardening", 0.2), ("drift", -0.05)] {
        let answer = diagnosed(vec![hidden(&[(id, amount)], 8, false)]);
        let said = crate::trial::line(&answer);
        assert_eq!(answer.verdict, Verdict::Named, "{said}");
        assert_eq!(answer.effects[0].id, id, "{said}");
        let found = &answer.effects[0].parameters[0];
        assert!((found.value / amount - 1.0).abs() < 0.15, "{found:?}");
        let [low, high] = found.interval;
        assert!((low..=high).contains(&amount), "{found:?}");
        let white = answer.whiteness.expect("a test");
        assert!(white[0] < 0.01 && white[1] > 0.01, "{white:?}");
        // of one cycle whose noise is stated, strong evidence carries a name
        let one = diagnosed(vec![hidden(&[(id, 5.0 * amount)], 1, true)]);
        let said = crate::trial::line(&one);
        assert_eq!(
            (one.verdict, &*one.effects[0].id),
            (Verdict::Named, id),
            "{said}"
        );
        assert!(one.prediction.is_empty(), "{said}");
        let unknown = diagnosed(vec![hidden(&[(id, 5.0 * amount)], 1, false)]);
        let said = crate::trial::line(&unknown);
        assert_eq!(unknown.verdict, Verdict::Unresolved, "{said}");
        let reason = unknown.reason.unwrap_or_default();
        assert!(reason.contains("not known"), "{said}");
    }
}

/// Checks that a channel and a condition held out by the case are compared at the end and used nowhere else.
#[test]
fn what_is_held_out_is_compared_at_the_end() {
    let effects = [("hardening", 0.6)];
    let mut own = hidden(&effects, 8, false);
    own.channels[1].held_out = true;
    let mut other = hidden(&effects, 4, false);
    other.condition = 1;
    let parts =
        |answer: &Diagnosis| -> Vec<DataRole> { answer.rows.iter().map(|row| row.part).collect() };
    let all = [
        DataRole::Fitted,
        DataRole::Cycles,
        DataRole::Channels,
        DataRole::Condition,
    ];
    let free = diagnosed(vec![own.clone(), other.clone()]);
    other.held_out = true;
    let held = diagnosed(vec![own, other]);
    for answer in [&free, &held] {
        let said = crate::trial::line(answer);
        assert_eq!(answer.verdict, Verdict::Named, "{said}");
        assert_eq!(answer.effects[0].id, "hardening", "{said}");
        assert_eq!(parts(answer), all);
        // only the first channel is fitted
        let entries = answer.after.as_ref().expect("a model").entries;
        assert_eq!(entries, SAMPLES - 1);
        let unseen = &answer.rows[2];
        assert!(
            unseen.before.len() == 1 && unseen.closed.closed > 0.8,
            "{:?}",
            unseen.closed
        );
    }
    // four parts of the abscissa, and the other condition where it may be looked at
    let shifts = |answer: &Diagnosis| answer.drifts[0].shifts.len();
    assert_eq!((shifts(&free), shifts(&held)), (5, 4));
}

/// Checks that an unknown of the case whose value has no influence is held fixed in every fit, and is still
/// found as a suspect under its own name, with a value to start from.
#[test]
fn an_unknown_that_is_off_is_a_suspect() {
    let mut values = space().values(&TRUTH);
    assert_eq!(values[1].to_bits(), 0.0_f64.to_bits());
    values[1] = 0.5;
    let answer = diagnosed(vec![record(78, 8, &curves(&values, &[]), false)]);
    let said = crate::trial::line(&answer);
    assert_eq!(answer.verdict, Verdict::Named, "{said}");
    let found = &answer.effects[0];
    assert_eq!(
        (found.id.as_str(), &found.unknowns[..]),
        ("softening", &[1][..]),
        "{said}"
    );
    assert!(
        (found.parameters[0].value / 0.5 - 1.0).abs() < 0.2,
        "{found:?}"
    );
    assert!(answer.limits.iter().any(|limit| limit.id == "softening"));
    // held at nothing without it: only two are fitted
    assert_eq!(answer.before.expect("a model").coordinates.len(), 2);
}

/// Checks a log whose noise size is stated but whose correlation is not: slow noise counts as a discrepancy,
/// healthy logs get no claim, and a hidden effect gets its name.
#[test]
fn slow_noise_that_is_not_stated_names_nothing() {
    let without = |seed: u64, effects: &[(&str, f64)]| {
        let clean = curves(&space().values(&TRUTH), effects);
        let mut own = record(seed, 1, &clean, true);
        for channel in &mut own.channels {
            channel.correlation = None;
        }
        own
    };
    let sets = diagnoses(4, 60);
    let mut claims = 0;
    for seed in 0..sets {
        let answer = diagnosed(vec![without(400 + seed, &[])]);
        // the noise is more than what is stated, so that something is left
        claims += usize::from(answer.verdict != Verdict::Unresolved);
    }
    say(&format!(
        "one log without a correlation: {claims} claims of {sets}"
    ));
    assert!(20 * claims as u64 <= sets, "{claims}");
    let answer = diagnosed(vec![without(450, &[("hardening", 0.8)])]);
    let said = crate::trial::line(&answer);
    assert_eq!(answer.verdict, Verdict::Named, "{said}");
    assert_eq!(answer.effects[0].id, "hardening", "{said}");
}

/// Checks that no effect is named on sensors with a fixed zero whose cycles drift by more than they scatter
/// between samples, with three and with six cycles.
#[test]
fn cycles_that_drift_name_nothing() {
    let drifting = |seed: u64, cycles: usize, effects: &[(&str, f64)]| {
        let clean = curves(&space().values(&TRUTH), effects);
        let mut own = record(seed, cycles, &clean, false);
        for channel in &mut own.channels {
            channel.channel.offset = Offset::Fixed;
        }
        let mut stream = Streams::new(seed, 22).at(0, Phase::Initial, 0);
        for cycle in &mut own.cycles {
            for (curve, size) in cycle.iter_mut().zip(SIZES) {
                let (shift, tilt) = (size * stream.normal(), size * stream.normal());
                for (y, t) in curve.iter_mut().zip(times()) {
                    *y += shift + tilt * (t - 2.5) / 3.0;
                }
            }
        }
        own
    };
    let sets = diagnoses(7, 100);
    for cycles in [3, 6] {
        let (mut claims, mut quiet) = (Vec::new(), 0);
        for seed in 0..sets {
            let answer = diagnosed(vec![drifting(700 + seed, cycles, &[])]);
            let claimed = !matches!(
                answer.verdict,
                Verdict::NothingDetected | Verdict::Unresolved
            );
            if claimed {
                claims.push(crate::trial::line(&answer));
            }
            quiet += usize::from(answer.verdict == Verdict::NothingDetected);
        }
        say(&format!(
            "{cycles} cycles that drift: {} claims, {quiet} of {sets} nothing detected",
            claims.len()
        ));
        assert!(20 * claims.len() as u64 <= sets, "{claims:#?}");
        assert!(10 * quiet as u64 >= 8 * sets, "{quiet} of {sets}");
    }
    let answer = diagnosed(vec![drifting(750, 6, &[("hardening", 0.4)])]);
    let said = crate::trial::line(&answer);
    assert_eq!(answer.verdict, Verdict::Named, "{said}");
    assert_eq!(answer.effects[0].id, "hardening", "{said}");
}

/// Checks that an effect with a threshold, without influence at its usual size, is found by trying values
/// along its range, and is never reported as absorbed by recalibration where it has no influence.
#[test]
fn what_acts_from_a_level_on_is_tried_along_its_range() {
    for level in [0.25, 0.45] {
        let answer = diagnosed(vec![hidden(&[("stop", level)], 8, false)]);
        let said = crate::trial::line(&answer);
        assert_eq!(answer.verdict, Verdict::Named, "{said}");
        assert_eq!(answer.effects[0].id, "stop", "{said}");
        let found = answer.effects[0].parameters[0].value;
        assert!((found / level - 1.0).abs() < 0.05, "{found} {level}");
    }
    let healthy = diagnosed(vec![hidden(&[], 8, false)]);
    assert!(healthy.absorbed.iter().all(|own| own.id != "stop"));
}

/// Checks that an instrument error far beyond its stated accuracy, which no library effect covers, does not
/// absorb the discrepancy: the nuisance parameter is held, the residual stays significant, and the reason
/// says so.
#[test]
fn instruments_do_not_swallow_what_is_missing() {
    let clean = curves(&space().values(&TRUTH), &[("gain", 0.08)]);
    let mut own = record(78, 8, &clean, false);
    own.stated.nuisances = vec![Nuisance {
        id: "force".to_owned(),
        parameter: "gain".to_owned(),
        unit: "1".to_owned(),
        acts: Acts::Gain { curve: 1 },
        deviation: 0.005,
        never_negative: false,
        assumed: false,
    }];
    // laws of another kind might make up for it on the one condition that there is
    let answer = diagnosed_without(vec![own], &["hardening", "late"]);
    let said = crate::trial::line(&answer);
    let reason = answer.reason.unwrap_or_default();
    assert_eq!(answer.verdict, Verdict::Unresolved, "{said}");
    assert!(
        reason.contains("force.gain") && reason.contains("a missing effect"),
        "{reason}"
    );
}

/// Checks that, with the end of a log held out, a named effect must predict the held-out part, and does.
#[test]
fn a_part_that_is_held_out_judges_the_name() {
    let whole = hidden(&[("hardening", 0.8)], 1, true);
    let count = times().len();
    let (begin, end): (Vec<usize>, Vec<usize>) = (0..count).partition(|k| 5 * k < 3 * count);
    let mut own = whole.clone();
    own.channels.clear();
    own.cycles = vec![Vec::new()];
    for (rows, held_out) in [(begin, false), (end, true)] {
        for (channel, curve) in whole.channels.iter().zip(&whole.cycles[0]) {
            let part = channel.part(rows.clone(), held_out);
            own.cycles[0].extend(part.pick(curve));
            own.channels.push(part);
        }
    }
    let answer = diagnosed(vec![own]);
    let said = crate::trial::line(&answer);
    assert_eq!(answer.verdict, Verdict::Named, "{said}");
    assert_eq!(answer.effects[0].id, "hardening", "{said}");
    let parts: Vec<DataRole> = answer.prediction.iter().map(|one| one.part).collect();
    assert_eq!(parts, [DataRole::Segment], "{said}");
    assert!(answer.prediction[0].nats > 3.0, "{:?}", answer.prediction);
}

/// Checks that a discrepancy smaller than the stated model error is not claimed and is noted, while a smaller
/// stated model error leaves the name.
#[test]
fn an_error_that_is_stated_of_any_model_hides_what_is_smaller() {
    let with_error = |shares: f64| {
        let mut own = hidden(&[("hardening", 0.2)], 8, false);
        for (channel, size) in own.channels.iter_mut().zip(SIZES) {
            channel.model_error = Some(shares * size);
        }
        diagnosed(vec![own])
    };
    let rough = with_error(30.0);
    assert!(rough.effects.is_empty(), "{}", crate::trial::line(&rough));
    assert!(rough.notes.iter().any(|note| note.contains("model_error")));
    let fine = with_error(0.05);
    assert_eq!(
        fine.verdict,
        Verdict::Named,
        "{}",
        crate::trial::line(&fine)
    );
}
