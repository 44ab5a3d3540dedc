//! Two effects and a third that resembles their sum: whichever is found first, the two are the answer.
use crate::by_curves::ByCurves;
use crate::case::{effect, size};
use crate::trial::{line, now};
use discrepancy::diagnose::{Diagnosis, Inputs, diagnose};
use discrepancy::record::{Curves, Record, Recorded, Stated};
use discrepancy::thresholds::Thresholds;
use discrepancy::verdict::Verdict;
use protocol::announce::{Place, Sign};
use protocol::case::{Abscissa, Channel, Offset, Scale, Unknown};
use protocol::job::{Numerics, SimulateSpec};
use search::random::{Phase, Streams};
use search::space::Space;

const SAMPLES: usize = 144;

/// A wave whose size is unknown with waves of other orders as effects, over a turn: the unknown, two waves, what resembles their sum, and two that have nothing to do with it.
fn curve(x: f64, amounts: &[(&str, f64)]) -> Vec<f64> {
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
            + amount("fourth") * (7.0 * t).sin()
            + amount("fifth") * (8.0 * t).cos()
    };
    (0..SAMPLES).map(at).collect()
}

fn waves(spec: &SimulateSpec) -> Curves {
    let own = &spec.individual;
    let effects = own.effects.iter();
    let effects: Vec<(&str, f64)> = effects
        .map(|e| (e.id.as_str(), e.parameters[0].1))
        .collect();
    vec![curve(own.genes[0], &effects)]
}

/// Diagnoses a record of both waves, the library in an order.
fn diagnosed(ids: &[&str], amounts: [f64; 2]) -> Diagnosis {
    let point = |k: usize| 360.0 * k as f64 / SAMPLES as f64;
    let channel = Channel {
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
    let truth = curve(3.0, &[("one", amounts[0]), ("other", amounts[1])]);
    let mut stream = Streams::new(41, 0).at(0, Phase::Initial, 0);
    let mut cycle = || vec![truth.iter().map(|y| y + 0.2 * stream.normal()).collect()];
    let unknowns = vec![Unknown::new("size", "N", Scale::Linear, 2.0, [0.0, 9.0])];
    let own = |id: &&str| {
        let sizes = vec![size("amount", "N", 0.5, Sign::Either)];
        effect(id, id, Place::Dynamics, sizes)
    };
    let inputs = Inputs {
        conditions: Vec::new(),
        differences: false,
        space: Space::new(&unknowns).expect("ordered"),
        unknowns,
        records: vec![Record {
            condition: 0,
            channels: vec![Recorded {
                scored: true,
                ..Recorded::new(0, &channel)
            }],
            cycles: (0..8).map(|_| cycle()).collect(),
            held_out: false,
            stated: Stated::default(),
        }],
        library: ids.iter().map(own).collect(),
        start: Some(vec![0.0]),
        usual: Numerics::OF_THE_CASE,
        finer: Vec::new(),
        entrance: "least-squares",
        seed: 1,
        thresholds: Thresholds {
            draws: 100,
            ..Thresholds::default()
        },
    };
    now(diagnose(&mut ByCurves(|spec| Some(waves(spec))), &inputs))
}

#[test]
fn two_effects_are_found_in_either_order_beside_one_that_resembles_their_sum() {
    for amounts in [[0.6, 0.5], [0.3, 0.7], [0.7, 0.3], [-0.5, -0.5]] {
        for ids in [
            ["one", "other", "sum", "fourth", "fifth"],
            ["sum", "fifth", "other", "one", "fourth"],
        ] {
            let answer = diagnosed(&ids, amounts);
            let said = line(&answer);
            let added = answer.after.as_ref().map(|fit| &fit.model.added);
            let mut found: Vec<&str> = added.into_iter().flatten().map(|e| &*e.id).collect();
            found.sort_unstable();
            assert_eq!(found, ["one", "other"], "{amounts:?} {ids:?} {said}");
            assert_eq!(answer.verdict, Verdict::Named, "{said}");
        }
    }
}
