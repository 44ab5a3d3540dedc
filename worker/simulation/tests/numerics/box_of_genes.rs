//! Tests over the whole search region: the paper's ten coefficients, each varied by four decades up and down
//! from its recommended value (section 5.3), sampled by a seeded Latin hypercube.
//!
//! Most of the region describes no working machine. Every individual must end within its iteration budget,
//! either complete or with a named failure, and the result of its statics must depend neither on the start of
//! the search for equilibrium nor on the damping of its steps.
use crate::rope::recommended;
use rand::seq::SliceRandom;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use simulation::drive::Drive;
use simulation::model::description::RopeLaw;
use simulation::model::{Machine, RopeMachine};
use simulation::observe::Recorder;
use simulation::reference;
use simulation::run::{RunResult, RunSettings, settle, simulate};
use simulation::settle::{BUDGET, Damping, guess};
use simulation::system::System;
use simulation::verdict::{Failure, Reached, Verdict};
use std::collections::BTreeMap;

/// Generates `count` points of a Latin hypercube in the ten-dimensional unit cube: one point per slice of
/// every dimension.
fn hypercube(count: usize, random: &mut impl Rng) -> Vec<[f64; 10]> {
    let mut points = vec![[0.0; 10]; count];
    for gene in 0..10 {
        let mut slices: Vec<usize> = (0..count).collect();
        slices.shuffle(random);
        for (point, slice) in points.iter_mut().zip(slices) {
            point[gene] = (slice as f64 + random.random::<f64>()) / count as f64;
        }
    }
    points
}

/// Returns a rope law: the recommended coefficients, each multiplied by a power of ten between `-decades` and
/// `+decades`.
fn individual(point: &[f64; 10], decades: f64) -> RopeLaw {
    let factor = point.map(|x| 10_f64.powf(decades * (2.0 * x - 1.0)));
    let mut law = recommended();
    let bushing = &mut law.bushing;
    let pairs = [
        &mut bushing.stiffness,
        &mut bushing.rotational_stiffness,
        &mut bushing.damping,
        &mut bushing.rotational_damping,
    ];
    for (k, pair) in pairs.into_iter().enumerate() {
        pair[0] *= factor[2 * k];
        pair[1] *= factor[2 * k + 1];
    }
    law.contact.stiffness *= factor[8];
    law.contact.damping *= factor[9];
    law
}

/// Builds the reference machine, or with `fine` the same machine with the real unit's 72 + 114 cylinders.
fn machine(fine: bool) -> Machine {
    let mut description = reference::description();
    if fine {
        description.rope.pitch = 0.05;
        description.rope.back = 72;
        description.rope.front = 114;
    }
    Machine::new(description, 2).unwrap()
}

/// Searches the static equilibrium with a given damping, optionally from a disturbed start; returns the
/// equilibrium or the failure, and the number of Newton iterations.
fn statics(
    machine: &Machine,
    law: &RopeLaw,
    damping: Damping,
    disturb: Option<(f64, &mut ChaCha8Rng)>,
) -> (Result<Vec<f64>, (Failure, f64)>, u64) {
    let settings = RunSettings {
        damping,
        ..RunSettings::default()
    };
    let drive = Drive {
        start: -settings.lead_in,
        ramp: settings.ramp,
        speed: machine.description.crank.speed,
    };
    let ropes = machine.ropes(law);
    let mut system = System::new(RopeMachine::new(machine, ropes, drive));
    let at = system.equations.drive_state(0.0);
    let layout = machine.layout;
    let width = layout.motion.width();
    let start = disturb.and_then(|(size, random)| {
        let mut q = guess(machine, &ropes, &at).ok()?;
        for (i, q) in q.iter_mut().enumerate() {
            // the rod and the suspension have one coordinate each, the rest of their block is locked
            let base = [layout.rod(), layout.suspension()];
            if !base
                .iter()
                .any(|&first| (first + 1..first + width).contains(&i))
            {
                *q += 2.0 * size * (random.random::<f64>() - 0.5);
            }
        }
        Some(q)
    });
    let found = settle(&mut system, &settings, start.as_deref());
    (found, system.statistics.newton_iterations)
}

fn named(result: &RunResult) -> String {
    match result.verdict {
        Verdict::Complete => "complete".to_owned(),
        Verdict::Failed { kind, reached } => match reached {
            Reached::LoadFraction(_) => format!("under load: {kind:?}"),
            Reached::TimeFraction(_) => format!("in motion: {kind:?}"),
        },
    }
}

fn quantiles(mut x: Vec<u64>) -> String {
    x.sort_unstable();
    let at = |share: usize| x[(x.len() - 1) * share / 100];
    format!("{} {} {} {}", at(50), at(90), at(99), at(100))
}

/// Checks that statics from five starts with three dampings agree, in verdict and in equilibrium, and end
/// within five budgets: one for the full load, and four for the searches for the largest load that is still
/// carried where the full load is not.
fn assert_statics(machine: &Machine, count: usize) {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut verdicts: BTreeMap<String, usize> = BTreeMap::new();
    let mut spent = Vec::new();
    for (k, point) in hypercube(count, &mut random).iter().enumerate() {
        let law = individual(point, 4.0);
        let plain = Damping::default();
        let (expected, iterations) = statics(machine, &law, plain, None);
        spent.push(iterations);
        // from the guess, its coordinates off by a millimetre to half a metre (and as many radians)
        for (weight, off) in [(100.0, 1e-3), (0.01, 1e-3), (1.0, 0.02), (1.0, 0.5)] {
            let damping = Damping {
                first: plain.first * weight,
                ..plain
            };
            let start = Some((off, &mut random));
            let (found, iterations) = statics(machine, &law, damping, start);
            assert!(iterations <= 5 * BUDGET, "individual {k}: {iterations}");
            spent.push(iterations);
            match (&expected, &found) {
                (Ok(expected), Ok(found)) => {
                    let apart = expected.iter().zip(found).map(|(a, b)| (a - b).abs());
                    let apart = apart.fold(0.0, f64::max);
                    assert!(apart < 1e-9, "individual {k}: {apart} {law:?}");
                }
                (Err(expected), Err(found)) => assert_eq!(expected, found, "individual {k}"),
                (expected, found) => {
                    assert_eq!(expected.is_ok(), found.is_ok(), "individual {k}");
                }
            }
        }
        let verdict = expected.map_or_else(|(kind, _)| format!("{kind:?}"), |_| "stands".into());
        *verdicts.entry(verdict).or_default() += 1;
    }
    println!("{count} individuals: {verdicts:?}");
    println!("iterations, 50 90 99 100 %: {}", quantiles(spent));
    assert!(verdicts["stands"] * 10 > count, "{verdicts:?}");
}

/// Checks that whole runs end within their budget, and that half of the failed ones are known within 1000
/// iterations.
fn assert_runs(machine: &Machine, count: usize, decades: f64) -> BTreeMap<String, Vec<u64>> {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let settings = RunSettings {
        samples: 72,
        longest_step: 0.06,
        ..RunSettings::default()
    };
    let mut verdicts: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    let mut failed = vec![0];
    for point in hypercube(count, &mut random) {
        let law = individual(&point, decades);
        let mut recorder = Recorder::gauges_only();
        let result = simulate(machine, &law, &settings, &mut recorder);
        let spent = result.statistics.newton_iterations;
        // a step in hand is finished
        assert!(spent <= settings.budget + 100, "{spent}");
        verdicts.entry(named(&result)).or_default().push(spent);
        if result.verdict == Verdict::Complete {
            assert_eq!(recorder.curves.gauge[0].len(), settings.samples);
        } else {
            failed.push(spent);
        }
    }
    println!("{count} individuals within {decades} decades; iterations, 50 90 99 100 %:");
    for (verdict, spent) in &verdicts {
        let quantiles = quantiles(spent.clone());
        println!("{verdict:<32} {:>5} times  {quantiles}", spent.len());
    }
    println!("all that failed {}", quantiles(failed.clone()));
    failed.sort_unstable();
    assert!(
        failed[failed.len() / 2] <= 1_000,
        "half of the failures are known after a tenth of what a good run takes"
    );
    verdicts
}

#[test]
fn statics_depend_on_neither_start_nor_damping() {
    assert_statics(&machine(false), 60);
}

#[test]
fn every_individual_ends_within_its_budget() {
    let verdicts = assert_runs(&machine(false), 40, 4.0);
    assert!(verdicts.len() > 2, "{verdicts:?}");
}

#[test]
fn close_to_the_recommended_values_nearly_all_complete() {
    let verdicts = assert_runs(&machine(false), 12, 1.0);
    assert!(verdicts["complete"].len() >= 11, "{verdicts:?}");
}

/// Runs the checks of statics and of whole runs with a thousand individuals on the real unit's
/// discretisation: `cargo test --release -p simulation --test numerics -- --ignored --nocapture thousand`.
#[test]
#[ignore = "minutes in a release build"]
fn a_thousand_individuals() {
    assert_statics(&machine(true), 1000);
    assert_runs(&machine(true), 1000, 4.0);
    assert_runs(&machine(true), 200, 1.0);
}
