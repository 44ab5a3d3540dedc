//! Tests of effects that resemble one another: an effect that mimics the sum of two others, twins that only a
//! second condition separates, and an effect present under the fitted condition only.
use crate::by_curves::ByCurves;
use crate::case::{effect, size};
use crate::trial::{line, now};
use discrepancy::diagnose::{Diagnosis, Inputs, diagnose};
use discrepancy::thresholds::Thresholds;
use discrepancy::verdict::Verdict;
use protocol::announce::{Place, Sign};
use protocol::case::{Abscissa, Channel, Offset, Scale, Unknown};
use protocol::job::{Numerics, SimulateSpec};
use record::{Curves, Record, Recorded, Stated};
use search::random::{Phase, Streams};
use search::space::Space;

pub(crate) const SAMPLES: usize = 144;

/// Returns a sine wave of unknown size plus the effects, which are waves of other orders over a turn.
///
/// `one` and `other` are two waves; `sum` resembles their sum; `fourth` and `fifth` are unrelated; `twin`
/// resembles `one` under the first condition and is a different wave under the second.
fn curve(x: f64, amounts: &[(&str, f64)], condition: usize) -> Vec<f64> {
    let amount = |id: &str| {
        let own = amounts.iter().find(|(name, _)| *name == id);
        own.map_or(0.0, |(_, amount)| *amount)
    };
    let at = |k: usize| {
        let t = std::f64::consts::TAU * k as f64 / SAMPLES as f64;
        let (one, other) = ((2.0 * t).sin(), (5.0 * t).cos());
        let sum = 0.8 * (one + other) + 0.15 * (3.0 * t).sin();
        x * t.sin()
            + amount("one") * one
            + amount("other") * other
            + amount("sum") * sum
            + amount("twin")
                * if condition == 0 {
                    one + 0.005 * (3.0 * t).sin()
                } else {
                    (4.0 * t).sin()
                }
            + amount("fourth") * (7.0 * t).sin()
            + amount("fifth") * (8.0 * t).cos()
    };
    (0..SAMPLES).map(at).collect()
}

/// Curve of a model: by the value of its unknown, the amounts of its effects and the condition.
pub(crate) type Model = fn(f64, &[(&str, f64)], usize) -> Vec<f64>;

/// Simulates a job with a model.
pub(crate) fn simulated(model: Model, spec: &SimulateSpec) -> Curves {
    let own = &spec.individual;
    let effects = own.effects.iter();
    let effects: Vec<(&str, f64)> = effects
        .map(|e| (e.id.as_str(), e.parameters[0].1))
        .collect();
    vec![model(own.genes[0], &effects, own.condition)]
}

/// Diagnoses one record per condition, each generated with its own hidden effects, with the library in the
/// given order.
fn diagnosed(ids: &[&str], hidden: &[&[(&str, f64)]], seed: u64) -> Diagnosis {
    let inputs = inputs(curve, 3.0, ids, hidden, seed);
    let mut lab = ByCurves(|spec| Some(simulated(curve, spec)));
    now(diagnose(&mut lab, &inputs))
}

/// Returns the inputs of a diagnosis of one record per condition, each generated at `x` with its own hidden
/// effects, with the library in the given order.
pub(crate) fn inputs(
    model: Model,
    x: f64,
    ids: &[&str],
    hidden: &[&[(&str, f64)]],
    seed: u64,
) -> Inputs {
    let point = |k: usize| 360.0 * k as f64 / SAMPLES as f64;
    let channel = Channel {
        limit: None,
        name: "wave".to_owned(),
        title: "wave".to_owned(),
        unit: "N".to_owned(),
        condition: 0,
        abscissa: Abscissa {
            name: "turn".to_owned(),
            unit: "deg".to_owned(),
            points: (0..SAMPLES).map(point).collect(),
            period: Some(360.0),
        },
        noise: None,
        step: None,
        weights: Vec::new(),
        offset: Offset::Free,
        record: None,
    };
    let mut stream = Streams::new(seed, 0).at(0, Phase::Initial, 0);
    let mut record = |condition: usize, amounts: &[(&str, f64)]| {
        let truth = model(x, amounts, condition);
        let mut cycle = || vec![truth.iter().map(|y| y + 0.2 * stream.normal()).collect()];
        Record {
            condition,
            channels: vec![Recorded {
                scored: true,
                ..Recorded::new(0, &channel)
            }],
            cycles: (0..8).map(|_| cycle()).collect(),
            held_out: false,
            stated: Stated::default(),
        }
    };
    let records = hidden.iter().enumerate();
    let unknowns = vec![Unknown::new("size", "N", Scale::Linear, 2.0, [0.0, 9.0])];
    let own = |id: &&str| {
        let sizes = vec![size("amount", "N", 0.5, Sign::Either)];
        effect(id, id, Place::Dynamics, sizes)
    };
    Inputs {
        conditions: Vec::new(),
        differentiates: true,
        differences: false,
        space: Space::new(&unknowns).expect("ordered"),
        unknowns,
        records: records.map(|(at, amounts)| record(at, amounts)).collect(),
        library: ids.iter().map(own).collect(),
        start: Some(vec![0.0]),
        families: None,
        usual: Numerics::FROM_CASE,
        finer: Vec::new(),
        global_search: "least-squares",
        seed: 1,
        thresholds: Thresholds {
            draws: 100,
            ..Thresholds::default()
        },
    }
}

/// Returns the identifiers of the effects that a diagnosis added.
fn added(answer: &Diagnosis) -> Vec<&str> {
    let added = answer.after.as_ref().map(|fit| &fit.added);
    added.into_iter().flatten().map(String::as_str).collect()
}

#[test]
fn two_effects_are_found_in_either_order_beside_one_that_resembles_their_sum() {
    for amounts in [[0.6, 0.5], [0.3, 0.7], [0.7, 0.3], [-0.5, -0.5]] {
        for ids in [
            ["one", "other", "sum", "fourth", "fifth"],
            ["sum", "fifth", "other", "one", "fourth"],
        ] {
            let both = [("one", amounts[0]), ("other", amounts[1])];
            let answer = diagnosed(&ids, &[&both], 41);
            let said = line(&answer);
            let mut found = added(&answer);
            found.sort_unstable();
            assert_eq!(found, ["one", "other"], "{amounts:?} {ids:?} {said}");
            assert_eq!(answer.verdict, Verdict::Named, "{said}");
        }
    }
}

/// Checks that twins, which explain the fitted record equally well (the wrong twin often slightly better),
/// form one ambiguity set until a second condition shows which twin is present.
#[test]
fn another_condition_tells_twins_apart() {
    let ids = ["one", "other", "twin", "fourth", "fifth"];
    for seed in 60..66 {
        for there in ["one", "twin"] {
            let hidden = [(there, 0.6)];
            let alone = diagnosed(&ids, &[&hidden], seed);
            let said = line(&alone);
            assert_eq!(alone.verdict, Verdict::Ambiguous, "{said}");
            let mut set = alone.rounds[0].set.clone();
            set.sort();
            assert_eq!(set, ["one", "twin"], "{said}");
            let both = diagnosed(&ids, &[&hidden, &hidden], seed);
            let said = line(&both);
            assert_eq!(both.verdict, Verdict::Named, "{said}");
            assert_eq!(added(&both), [there], "{said}");
        }
    }
}

/// Checks that an effect is removed again if it explains the fitted record together with another effect but
/// predicts changes under a second condition that are not observed, and that the other effect stays.
#[test]
fn an_effect_that_predicts_what_does_not_happen_is_taken_back() {
    let ids = ["one", "other", "sum", "fourth", "fifth"];
    let (here, there) = ([("one", 0.6), ("fourth", 0.4)], [("one", 0.6)]);
    let answer = diagnosed(&ids, &[&here, &there], 70);
    let said = line(&answer);
    assert_eq!(added(&answer), ["one"], "{said}");
    let mut reasons = answer
        .rounds
        .iter()
        .filter_map(|round| round.reason.as_ref());
    assert!(
        reasons
            .any(|reason| reason.starts_with("fourth") && reason.contains("log likelihood falls")),
        "{said}"
    );
}
