//! Tests of the search for the narrow valley of the rope's stiffness.
//!
//! The rope of the machine rings at orders near sixty and eighty, so that a stiffness wrong by a few
//! hundredths of a decade gives waves of the wrong phase, and a clock error of one degree moves the valley
//! away. Each test also runs without the valley search, to show that the search is both necessary and
//! sufficient.
use crate::by_curves::ByCurves;
use crate::case;
use crate::trial::now;
use crate::truth::recorded;
use discrepancy::diagnose::{Diagnosis, Inputs, diagnose};
use discrepancy::laboratory::Stage;
use discrepancy::linear::whitened::WhitenedRecord;
use discrepancy::model::experiments::Experiments;
use discrepancy::model::{Fit, FittedModel, Point};
use discrepancy::thresholds::Thresholds;
use discrepancy::verdict::Verdict;
use discrepancy::{baseline::narrow_minimum, hypothesis::low_orders, hypothesis::signature};
use nalgebra::Complex;
use protocol::announce::{EffectDescriptor, Place, Sign};
use protocol::job::{Numerics, SimulateSpec};
use record::{Curves, Record, Stated};
use search::least_squares;
use search::random::{Phase, Streams};
use search::space::Space;
use std::f64::consts::TAU;

const SAMPLES: usize = 360;
const ORDERS: usize = 120;
/// Turns of the crank per second.
const TURNS: f64 = 5.0 / 60.0;
/// Orders of the two rope modes at the recommended stiffness; `SHARES` has the share of each mode in each
/// gauge.
const MODES: [f64; 2] = [57.0, 76.0];
const SHARES: [[f64; 4]; 2] = [[0.09, 0.05, -0.06, 0.04], [-0.05, 0.06, 0.04, -0.07]];
const STATIC: [f64; 4] = [0.5, -0.35, 0.45, 0.3];
/// Stress that rotates with the crank independently of the load, by gauge (MPa).
const WEIGHT: [f64; 4] = [2.0, 1.5, -1.0, 2.5];
/// Stiffness of the rope's contact relative to the searched contact stiffness; in series with the rope.
const CONTACT: f64 = 80.0;
/// Standard deviation of the noise of a sample (MPa).
const NOISE: f64 = 0.05;

/// True values of a test machine: unknowns in decades, clock error of the load card (deg).
#[derive(Clone, Copy)]
struct Ringing {
    stiffness: f64,
    damping: f64,
    clock: f64,
}

fn space() -> Space {
    let mut unknowns = [
        case::unknown("stiffness", 5e8, case::STIFFNESS),
        case::unknown("loss", 4e5, case::LOSS),
        case::unknown("contact", 3e8, [-0.5, 3.5]),
    ];
    unknowns[0].valley = Some(case::valley("loss", "contact"));
    Space::new(&unknowns).expect("positive and ordered")
}

fn library() -> Vec<EffectDescriptor> {
    let effect = |id: &str, unit: &str, typical: f64| {
        let parameters = vec![case::size("size", unit, typical, Sign::Either)];
        case::effect(id, "load_card", Place::Load, parameters)
    };
    vec![
        effect("card_time_shift", "deg", 0.2),
        effect("load_cell_lag", "rad", 0.005),
        effect("load_cell_gain", "1", 0.02),
    ]
}

/// Returns the gauge stresses over a turn of the crank: static response, two rope modes, rotating weight.
fn gauges(genes: [f64; 3], clock: f64, lag: f64, gain: f64) -> Curves {
    let [rope, loss, contact] = genes;
    let stiffness = 1.0 / (1.0 / rope + 1.0 / (CONTACT * contact));
    // the contact is in the way of the second mode only
    let softer = [
        (rope / 5e8).sqrt(),
        (stiffness / (1.0 / (1.0 / 5e8 + 1.0 / (CONTACT * 3e8)))).sqrt(),
    ];
    let mut curves: Curves = (0..4)
        .map(|c| (0..SAMPLES).map(|i| WEIGHT[c] * turn(1, i).re).collect())
        .collect();
    for order in 1..=ORDERS {
        let h = order as f64;
        // amplitude and phase of a rough card
        let phase = (2.4 * h * h).rem_euclid(TAU) - h * clock.to_radians();
        let load = Complex::from_polar(25.0 / h.powf(1.2) * (1.0 + gain), phase)
            * Complex::new(1.0, h * lag);
        let mode = |k: usize| {
            let n = MODES[k] * softer[k];
            let damping = 0.5 * loss / rope * TAU * TURNS * n;
            let r = h / n;
            Complex::from(1.0) / Complex::new(1.0 - r * r, 2.0 * damping * r)
        };
        let modes = [mode(0), mode(1)];
        for (c, curve) in curves.iter_mut().enumerate() {
            let share = modes[0] * SHARES[0][c] + modes[1] * SHARES[1][c];
            let answer = load * (share + STATIC[c]);
            for (i, y) in curve.iter_mut().enumerate() {
                *y += (answer * turn(order, i)).re;
            }
        }
    }
    curves
}

/// Returns the phasor `exp(i order phi)` at the crank angle of a sample.
fn turn(order: usize, sample: usize) -> Complex<f64> {
    let angle = TAU * (order * sample % SAMPLES) as f64 / SAMPLES as f64;
    Complex::from_polar(1.0, angle)
}

fn ropes(spec: &SimulateSpec) -> Curves {
    let amount = |id: &str| {
        let given = spec.individual.effects.iter().find(|e| e.id == id);
        given.map_or(0.0, |e| e.parameters[0].1)
    };
    let genes = &spec.individual.genes;
    let genes = [genes[0], genes[1], genes[2]];
    let (clock, lag) = (amount("card_time_shift"), amount("load_cell_lag"));
    gauges(genes, clock, lag, amount("load_cell_gain"))
}

fn record(truth: Ringing) -> Record {
    let space = space();
    let genes = space.values(&[truth.stiffness, truth.damping, 0.1]);
    let clean = gauges([genes[0], genes[1], genes[2]], truth.clock, 0.0, 0.0);
    let mut stream = Streams::new(5, 3).at(0, Phase::Initial, 0);
    let mut noisy = || -> Curves {
        let mut noise = |y: &f64| y + NOISE * stream.normal();
        clean
            .iter()
            .map(|c| c.iter().map(&mut noise).collect())
            .collect()
    };
    Record {
        condition: 0,
        channels: (0..4).map(|c| recorded(c, SAMPLES, None)).collect(),
        cycles: (0..8).map(|_| noisy()).collect(),
        held_out: false,
        stated: Stated::default(),
    }
}

/// Returns the record whitened by its own noise.
fn whole(truth: Ringing) -> WhitenedRecord {
    WhitenedRecord::under_own_noise(record(truth), ORDERS, Numerics::FROM_CASE)
}

/// Creates a simulation context that compares with a record and is charged to the global search stage.
fn basin<'a>(lab: &'a mut ByCurves, on: &'a WhitenedRecord) -> Experiments<'a, ByCurves> {
    Experiments {
        lab,
        on,
        stage: Stage::Basin,
    }
}

/// Returns the machine without effects at the given genes (decades).
fn at(genes: [f64; 3]) -> Point {
    Point {
        model: FittedModel::plain(space()),
        x: genes.to_vec(),
    }
}

/// Diagnoses a machine; `valley` is the misfit from which the search for another narrow minimum starts.
fn diagnosed(truth: Ringing, valley: f64) -> Diagnosis {
    let inputs = Inputs {
        conditions: Vec::new(),
        differentiates: true,
        differences: false,
        space: space(),
        unknowns: Vec::new(),
        records: vec![record(truth)],
        library: library(),
        start: None,
        families: None,
        usual: Numerics::FROM_CASE,
        finer: vec![Numerics::FROM_CASE],
        global_search: "quick",
        seed: 1,
        thresholds: Thresholds {
            draws: 20,
            valley,
            ..Thresholds::default()
        },
    };
    now(diagnose(&mut ByCurves(|spec| Some(ropes(spec))), &inputs))
}

/// Returns `chi^2` per element of the residual of the diagnosed model, and the model's rope stiffness
/// (decades).
fn end(diagnosis: &Diagnosis) -> (f64, f64) {
    let fit = diagnosis.after.as_ref().expect("a model");
    (fit.chi_squared / fit.entries as f64, fit.coordinates[0])
}

/// Checks that the valley search leads from a fit outside the valley into it, and finds nothing better from
/// inside.
#[test]
fn a_fit_outside_the_valley_finds_its_way_into_it() {
    let truth = Ringing {
        stiffness: 0.14,
        damping: 0.2,
        clock: 0.0,
    };
    let whole = whole(truth);
    let mut ropes = ByCurves(|spec| Some(ropes(spec)));
    let mut experiments = basin(&mut ropes, &whole);
    let left = |fit: &Fit| fit.chi_squared() / whole.metric.len() as f64;
    let outside = now(experiments.fit(
        at([0.6, 0.2, 0.0]),
        least_squares::LeastSquaresSettings::short(1),
    ));
    let outside = outside.expect("it simulates");
    assert!(left(&outside) > 9.0, "{}", left(&outside));
    let found = now(narrow_minimum::scan(&mut experiments, &outside)).expect("a valley");
    assert!(left(&found) < 1.3, "{}", left(&found));
    assert!((found.x()[0] - truth.stiffness).abs() < 0.01);
    let inside = at([truth.stiffness, truth.damping, 0.1]);
    let inside = now(experiments.fit(inside, least_squares::LeastSquaresSettings::short(8)));
    let inside = inside.expect("it simulates");
    assert!(now(narrow_minimum::scan(&mut experiments, &inside)).is_none());
}

/// Checks that a load card 1.5 degrees late is named: without that effect in the model there is no valley to
/// calibrate to.
#[test]
fn an_effect_that_hides_the_valley_is_named_from_inside_it() {
    let truth = Ringing {
        stiffness: 0.14,
        damping: 0.2,
        clock: 1.5,
    };
    let (left, _) = end(&diagnosed(truth, f64::INFINITY));
    assert!(left > 9.0, "{left}: the refits found the valley alone");
    let answer = diagnosed(truth, Thresholds::default().valley);
    let said = crate::trial::line(&answer);
    let (left, stiffness) = end(&answer);
    assert_eq!(answer.verdict, Verdict::Named, "{said}");
    assert_eq!(answer.effects[0].id, "card_time_shift", "{said}");
    let clock = answer.effects[0].parameters[0].value;
    assert!((clock / truth.clock - 1.0).abs() < 0.02, "{clock}");
    assert!(left < 1.3, "{left}: {said}");
    assert!((stiffness - truth.stiffness).abs() < 0.01, "{stiffness}");
}

/// Checks that, from a fit that has suppressed the modes, the test over all orders sees less than half of the
/// clock error, while the test over low orders finds its full size and the stiffness.
#[test]
fn low_orders_see_the_size_that_the_modes_hide() {
    let truth = Ringing {
        stiffness: 0.14,
        damping: 0.2,
        clock: 4.0,
    };
    let whole = whole(truth);
    let mut ropes = ByCurves(|spec| Some(ropes(spec)));
    let mut experiments = basin(&mut ropes, &whole);
    let lost = now(experiments.fit(
        at([1.9, -1.9, 0.0]),
        least_squares::LeastSquaresSettings::short(6),
    ));
    let lost = lost.expect("it simulates");
    let library = library();
    let clock = |scaled: f64| scaled * library[0].parameters[0].scale;
    let all = now(signature::examine(&mut experiments, &lost, &library));
    assert!(
        clock(all[0].start[0]) < 0.5 * truth.clock,
        "{:?}",
        all[0].start
    );
    let found = now(low_orders::likeliest(
        &mut experiments,
        &lost,
        &library,
        ORDERS,
    ));
    let Point { model, x } = &found[0];
    assert_eq!(model.added[0].id, "card_time_shift");
    assert!((clock(x[3]) / truth.clock - 1.0).abs() < 0.01, "{x:?}");
    assert!((x[0] - truth.stiffness).abs() < 0.01, "{x:?}");
}
