//! Tests of twin ropes on the reference machine: two chains per head compared with one, and with each other.
use crate::rope::{optimised, recommended};
use simulation::model::Machine;
use simulation::model::description::{Description, RopeLaw};
use simulation::observe::{Curves, Recorder};
use simulation::reference;
use simulation::run::{RunResult, RunSettings, simulate};
use simulation::verdict::Verdict;

fn run(description: Description, law: &RopeLaw) -> (RunResult, Curves) {
    let machine = Machine::new(description, 2).unwrap();
    let settings = RunSettings {
        samples: 72,
        ..RunSettings::default()
    };
    let mut recorder = Recorder::everything(36);
    let result = simulate(&machine, law, &settings, &mut recorder);
    assert_eq!(result.verdict, Verdict::Complete);
    (result, recorder.curves)
}

/// Returns the largest difference between the gauge signals of two runs, relative to each gauge's range.
fn apart(a: &Curves, b: &Curves) -> f64 {
    let each = a.gauge.iter().zip(&b.gauge).map(|(a, b)| {
        let highest = b.iter().fold(f64::MIN, |m, x| m.max(*x));
        let lowest = b.iter().fold(f64::MAX, |m, x| m.min(*x));
        let most = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        most.fold(0.0, f64::max) / (highest - lowest)
    });
    each.fold(0.0, f64::max)
}

fn twisted(law: &RopeLaw, factor: f64) -> RopeLaw {
    let mut other = *law;
    other.bushing.rotational_stiffness[0] *= factor;
    other.bushing.rotational_damping[0] /= factor;
    other
}

/// Checks that twins of equal length share the load evenly and stay in their planes: the same steps as with a
/// single rope, and gauge signals equal to 1e-8 of their range, for any torsional stiffness.
#[test]
fn twins_of_equal_length_are_the_single_rope() {
    for law in [recommended(), optimised()] {
        let (single, one) = run(reference::description(), &law);
        for factor in [1.0, 1e-2, 1e2] {
            let (twins, two) = run(reference::twins([0.0; 2]), &twisted(&law, factor));
            eprintln!("torsion times {factor}: {:e}", apart(&two, &one));
            assert_eq!(twins.statistics, single.statistics);
            assert!(apart(&two, &one) < 1e-8);
            let uneven = two.tension_difference.iter().flatten();
            assert!(uneven.map(|t| t.abs()).fold(0.0, f64::max) < 1e-3);
            for (a, b) in two.back_tension.iter().zip(&one.back_tension) {
                assert!((a / b - 1.0).abs() < 1e-8, "{a} {b}");
            }
            for (a, b) in two.shapes.iter().zip(&one.shapes) {
                for (a, b) in a.tension.iter().flatten().zip(b.tension.iter().flatten()) {
                    assert!((a - b).abs() < 1e-6 * b.abs().max(1e4), "{a} {b}");
                }
            }
        }
    }
}

/// Checks that the longer of two ropes carries less, by `dL EA / (2 L)` where the contact is stiff, while the
/// sum of both is unchanged. The front ropes are not affected by the lengths of the back ropes.
#[test]
fn unequal_twins_share_the_load_by_their_stiffness() {
    let law = optimised();
    let (_, one) = run(reference::description(), &law);
    let longer = 0.002;
    let (_, two) = run(reference::twins([longer, 0.0]), &law);
    let rope = reference::description().rope;
    // the law is that of a cylinder of the reference length
    let stiffness = law.bushing.stiffness[0] * rope.reference_pitch;
    let expected = longer * stiffness / (2.0 * rope.pitch * rope.back as f64);
    let [back, front] = &two.tension_difference;
    let mean = back.iter().sum::<f64>() / back.len() as f64;
    eprintln!("{mean} N, expected {expected} N; front {:e}", front[0]);
    assert!((mean / expected - 1.0).abs() < 0.05, "{mean} {expected}");
    assert!(front.iter().all(|t| t.abs() < 1.0));
    let sum = |curves: &Curves| curves.back_tension.iter().sum::<f64>();
    assert!((sum(&two) / sum(&one) - 1.0).abs() < 2e-3);
    // what the sides of a pair are called changes nothing but the sign
    let (_, other) = run(reference::twins([-longer, 0.0]), &law);
    for (a, b) in back.iter().zip(&other.tension_difference[0]) {
        assert!((a + b).abs() < 1e-3 * expected, "{a} {b}");
    }
}

/// Checks that the energy balance closes with twin ropes of unequal length.
#[test]
fn ledger_of_the_twins_closes() {
    for law in [recommended(), optimised()] {
        let (result, _) = run(reference::twins([0.002, -0.001]), &law);
        let gained = result.work.input - result.work.output - result.work.dissipated;
        let defect = (result.stored - gained).abs() / result.work.input;
        eprintln!("defect {defect:e}");
        assert!(defect < 1e-4, "{defect}");
    }
}
