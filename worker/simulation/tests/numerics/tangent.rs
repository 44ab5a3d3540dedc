//! Tests of the tangent matrix of a rig against differences of its forces, and of the two tangents of a
//! machine's stage against each computed separately.
use crate::rope::*;
use simulation::drive::Drive;
use simulation::effect::{EffectRequest, Selection};
use simulation::model::{Machine, RopeMachine};
use simulation::reference;
use simulation::rig::{Drum, End, Rig, Setup};
use simulation::settle::guess;
use simulation::system::{Equations, StateRef, StateShift, System};

/// Checks `mu M - gamma D - K` against central differences, coordinate by coordinate, for a disturbed, moving
/// chain on a drum with a revolute base and a loaded free end.
#[test]
fn tangent_is_the_derivative_of_the_forces() {
    let setup = Setup {
        gravity: V3::new(0.4, -9.81, 0.7),
        ends: [
            End::Held {
                place: V3::zeros(),
                angle: 0.2,
                law: soft().bushing.revolute(),
            },
            End::Free {
                force: V3::new(300.0, -700.0, 110.0),
                twist: 0.4,
                turn: -0.3,
            },
        ],
        drum: Some(Drum {
            center: [0.2, -1.9],
            radius: 1.902,
            law: optimised().contact,
        }),
        ..cantilever(8, soft().bushing)
    };
    let mut system = System::new(Rig::new(setup));
    let n = 48;
    let mut q = system.equations.straight(V3::zeros(), 0.0);
    let mut v = vec![0.0; n];
    for i in 0..n {
        q[i] += 1e-3 * (12.9898 * i as f64).sin();
        v[i] = 0.05 * (78.233 * i as f64).cos();
    }
    let mut force = vec![0.0; n];
    for (mu, gamma) in [(0.0, 0.0), (1600.0, 40.0)] {
        let mut matrix = system.equations.matrix();
        let shift = StateShift {
            mass: mu,
            damping: gamma,
        };
        let mut loads = system.forces(StateRef::new(0.0, &q, &v), &mut force);
        loads.tangent(shift, &mut matrix);
        assert!(
            system
                .equations
                .state
                .contact
                .iter()
                .filter(|&&f| f > 0.0)
                .count()
                > 2
        );
        for i in 0..n {
            let mut unit = vec![0.0; n];
            unit[i] = 1.0;
            let column = matrix.product(&unit);
            let mut moved = |h: f64| {
                let (mut q, mut v, mut force) = (q.clone(), v.clone(), vec![0.0; n]);
                q[i] += h;
                v[i] += gamma * h;
                system.forces(StateRef::new(0.0, &q, &v), &mut force);
                force
            };
            let h = 1e-7;
            let (plus, minus) = (moved(h), moved(-h));
            let mut inertia = vec![0.0; n];
            system.equations.subtract_inertia(&q, &unit, &mut inertia);
            let scale = column.iter().map(|x| x.abs()).fold(0.0, f64::max);
            for r in 0..n {
                let numeric = -(plus[r] - minus[r]) / (2.0 * h) - mu * inertia[r];
                // forces of 3e5 N are rounded to 1e-10 N, and divided by 2e-7
                let error = (numeric - column[r]).abs();
                assert!(
                    error < 2e-6 * scale + 1e-3,
                    "row {r} column {i}: {numeric} {}",
                    column[r]
                );
            }
        }
    }
}

/// Checks that the position and rate tangents of a stage, and their combination, equal the tangents computed
/// separately, in the plane and in space.
#[test]
fn tangents_of_a_stage_are_those_of_each_alone() {
    let drive = Drive {
        start: 1.0,
        ramp: 1.0,
        speed: 0.5,
    };
    let plane = Machine::new(reference::description(), 2).unwrap();
    let toe = EffectRequest {
        id: "rope_toe",
        parameters: vec![("strain", 7.5e-4), ("tension", 6e4)],
    };
    let toe = Selection::new(&[toe]).unwrap();
    let toe = Machine::with_effects(reference::description(), 2, toe.effects()).unwrap();
    for machine in [plane.clone(), plane.in_space(), toe] {
        let ropes = machine.ropes(&reference::law());
        let mut system = System::new(RopeMachine::new(&machine, ropes, drive));
        let state = system.equations.drive_state(0.0);
        let mut q = guess(&machine, &ropes, &state).unwrap();
        let n = q.len();
        let wave = |i: usize, k: f64| (k * i as f64 + 0.3).sin();
        for (i, q) in q.iter_mut().enumerate() {
            *q += 1e-5 * wave(i, 12.9898);
        }
        let v: Vec<f64> = (0..n).map(|i| 0.05 * wave(i, 78.233)).collect();
        let a: Vec<f64> = (0..n).map(|i| wave(i, 3.7)).collect();
        let mut force = vec![0.0; n];
        let shift = StateShift {
            mass: 1600.0,
            damping: 40.0,
        };
        let mut matrices: [_; 4] = std::array::from_fn(|_| system.equations.matrix());
        let mut loads = system.forces(StateRef::new(0.0, &q, &v), &mut force);
        let [alone, both, pair @ ..] = &mut matrices;
        loads.exact_tangent(&a, StateShift::NONE, alone);
        loads.exact_tangent(&a, shift, both);
        // one that was used is filled as a new one is
        let [stiffness, matrix] = pair;
        loads.exact_tangents(&a, shift, [&mut *stiffness, &mut *matrix]);
        matrix.factorize().unwrap();
        loads.exact_tangents(&a, shift, [&mut *stiffness, &mut *matrix]);
        let x: Vec<f64> = (0..n).map(|i| wave(i, 1.1)).collect();
        for (expected, found) in [(alone, stiffness), (both, matrix)] {
            let [expected, found] = [expected, found].map(|matrix| matrix.product(&x));
            let size = expected.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
            for (i, (expected, found)) in expected.iter().zip(&found).enumerate() {
                let apart = (expected - found).abs();
                assert!(apart < 1e-12 * size, "{i}: {expected} {found}");
            }
        }
    }
}
