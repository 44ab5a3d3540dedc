//! The energy ledger: what goes in is stored, comes out or is lost.
//!
//! `E(t1) - E(t0) = W_in - W_out - W_lost` with `W` from the powers at the method's own stages. A
//! wrong sign of any force breaks it, however right the derivatives are.
use crate::rope::*;
use nalgebra::Vector3;
use simulation::element::bushing::Bushing;
use simulation::element::impact::Impact;
use simulation::integrator::tableau::{CATALOGUE, Tableau};
use simulation::model::Machine;
use simulation::observe::Recorder;
use simulation::reference;
use simulation::rig::{Drum, Rig, Setup};
use simulation::run::{RunSettings, simulate};
use simulation::system::System;
use simulation::verdict::Verdict;

/// A named rig, where it starts and for how long it runs.
struct Example {
    name: &'static str,
    setup: Setup,
    start: V3,
    time: f64,
}

fn examples() -> Vec<Example> {
    let falling = |name, law: Bushing, count| Example {
        name,
        setup: Setup {
            gravity: Vector3::new(0.0, -9.81, 0.0),
            ..cantilever(count, law)
        },
        start: V3::zeros(),
        time: 1.0,
    };
    let mut loose = falling("chain thrown on a drum", soft().bushing, 30);
    loose.setup.ends[0] = simulation::rig::End::free();
    loose.setup.drum = Some(Drum {
        center: [0.9, -1.0],
        radius: 0.8,
        law: Impact {
            stiffness: 4e6,
            exponent: 1.5,
            damping: 300.0,
            full_damping_penetration: 1e-3,
        },
    });
    loose.time = 0.5;
    vec![
        falling("recommended rope falls", recommended().bushing, 40),
        falling("optimised rope falls", optimised().bushing, 40),
        falling("soft rope swings down", soft().bushing, 30),
        loose,
    ]
}

/// Defect of the ledger over the energy that was moved, and that energy \[J\].
fn defect(example: &Example, method: &'static Tableau, tolerance: f64) -> (f64, f64) {
    let mut setup = example.setup;
    setup.accuracy = tolerance.min(1.0);
    let mut system = System::new(Rig::new(setup));
    let q = system.equations.straight(example.start, 0.0);
    let v = vec![0.0; q.len()];
    let mut state = started(&mut system, q, v);
    let first = system.equations.energy(&state.q, &state.v);
    let mut lost = 0.0;
    let course = Course {
        method,
        tolerance,
        longest: 0.01,
    };
    let mut kinetic: f64 = 0.0;
    advance(
        &mut system,
        &course,
        &mut state,
        example.time,
        |_, to, step| {
            lost += step.work.dissipated;
            let speed2: f64 = to.v.chunks(6).map(|v| v[0] * v[0] + v[1] * v[1]).sum();
            kinetic = kinetic.max(0.5 * setup.chain.mass * speed2);
        },
    );
    let last = system.equations.energy(&state.q, &state.v);
    let moved = kinetic + lost;
    ((last - first + lost).abs() / moved, moved)
}

/// Every example rig, both methods: the ledger closes, and the tighter the tolerance the better.
#[test]
fn ledger_of_every_rig_closes_and_tightens_with_the_tolerance() {
    for example in examples() {
        for method in CATALOGUE {
            let defects = [1.0, 1e-1, 1e-2, 1e-3].map(|t| defect(&example, method, t));
            eprintln!("{} {}: {defects:?}", example.name, method.name);
        }
    }
}

/// The reference machine over one revolution: crank work in, load work out, losses, stored energy.
#[test]
fn ledger_of_the_reference_machine_closes() {
    let machine = Machine::new(reference::description(), 2).unwrap();
    for method in CATALOGUE {
        for tolerance in [1.0, 0.1, 0.01] {
            let settings = RunSettings {
                method,
                tolerance,
                budget: 10_000_000,
                ..RunSettings::default()
            };
            let mut recorder = Recorder::gauges_only();
            let run = simulate(&machine, &reference::law(), &settings, &mut recorder);
            assert_eq!(run.verdict, Verdict::Complete);
            let defect = run.stored - run.work.input + run.work.output + run.work.dissipated;
            eprintln!(
                "machine {} tolerance {tolerance}: {:.2e} of {:.0} J, {:?} {:?}",
                method.name,
                defect / run.work.input,
                run.work.input,
                run.work,
                run.statistics
            );
        }
    }
}
