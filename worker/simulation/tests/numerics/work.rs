//! Snapshots of the work of named runs, in counters that do not depend on the computer.
//!
//! A change of a method, tolerance, refactorisation policy or law shows here before it shows in run time. To
//! update: run the test, compare the counters before and after in its message, decide whether the change is
//! wanted, and copy the new numbers here.
use crate::rope::*;
use simulation::integrator::method::{CATALOGUE, Method, SPECTRAL_RADIUS};
use simulation::integrator::tableau::{ESDIRK4, TR_BDF2};
use simulation::model::Machine;
use simulation::observe::Recorder;
use simulation::reference;
use simulation::rig::{End, Rig};
use simulation::run::{RunSettings, simulate};
use simulation::statistics::Statistics;
use simulation::system::System;

/// Returns the counters as an array: steps, rejections by error and by Newton, Newton iterations, Jacobians,
/// factorisations.
fn counters(statistics: &Statistics) -> [u64; 6] {
    let Statistics {
        steps,
        error_rejections,
        newton_rejections,
        newton_iterations,
        jacobians,
        factorizations,
        ..
    } = *statistics;
    [
        steps,
        error_rejections,
        newton_rejections,
        newton_iterations,
        jacobians,
        factorizations,
    ]
}

fn machine(method: Method) -> Statistics {
    let machine = Machine::new(reference::description(), 2).unwrap();
    let settings = RunSettings {
        method,
        ..RunSettings::default()
    };
    let mut recorder = Recorder::gauges_only();
    simulate(&machine, &reference::law(), &settings, &mut recorder).statistics
}

fn falling(law: simulation::element::bushing::Bushing, course: Course) -> Statistics {
    let mut setup = cantilever(60, law);
    setup.gravity = V3::new(0.0, -9.81, 0.0);
    let mut system = System::new(Rig::new(setup));
    let q = system.equations.straight(V3::zeros(), 0.0);
    let v = vec![0.0; q.len()];
    let mut state = started(&mut system, q, v);
    advance(&mut system, &course, &mut state, 1.0, |_, _, _| {});
    system.statistics
}

fn settling() -> Statistics {
    let mut setup = cantilever(40, recommended().bushing);
    setup.ends[1] = End::Free {
        force: V3::new(0.0, -100.0, 0.0),
        twist: 0.0,
        turn: 0.0,
    };
    settled_straight(&setup).0.statistics
}

#[test]
fn named_runs_cost_what_they_did() {
    assert_eq!(CATALOGUE.len(), 5, "a new method wants a run of its own");
    let course = |method| Course {
        method,
        ..Course::accurate(1.0)
    };
    let runs = [
        (
            "reference machine, ESDIRK4",
            machine(Method::RungeKutta(&ESDIRK4)),
            [694, 0, 20, 7633, 490, 490],
        ),
        (
            "reference machine, TR-BDF2",
            machine(Method::RungeKutta(&TR_BDF2)),
            [687, 0, 16, 3388, 344, 344],
        ),
        (
            "optimised rope falls, ESDIRK4",
            falling(optimised().bushing, course(Method::RungeKutta(&ESDIRK4))),
            [102, 0, 0, 596, 10, 10],
        ),
        (
            "soft rope falls, ESDIRK4",
            falling(soft().bushing, course(Method::RungeKutta(&ESDIRK4))),
            [117, 0, 10, 1978, 391, 391],
        ),
        (
            "soft rope falls, TR-BDF2",
            falling(soft().bushing, course(Method::RungeKutta(&TR_BDF2))),
            [117, 0, 11, 999, 189, 189],
        ),
        (
            "reference machine, RODAS4",
            machine(Method::Rosenbrock),
            [685, 29, 0, 4290, 1435, 721],
        ),
        (
            "reference machine, generalised-alpha",
            machine(Method::GeneralizedAlpha {
                spectral_radius: SPECTRAL_RADIUS,
            }),
            [919, 7, 78, 3501, 547, 547],
        ),
        (
            "reference machine, BDF up to order 2",
            machine(Method::Bdf { highest: 2 }),
            [715, 1, 38, 2547, 354, 354],
        ),
        ("cantilever settles", settling(), [0, 0, 0, 40, 40, 40]),
    ];
    let mut changed = Vec::new();
    for (name, statistics, before) in runs {
        let now = counters(&statistics);
        eprintln!("{name} {now:?}");
        if now != before {
            changed.push(format!("{name}: {before:?} before, {now:?} now"));
        }
    }
    assert!(changed.is_empty(), "{}", changed.join("\n"));
}
