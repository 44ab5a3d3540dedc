use super::{ForceBuffers, Machine, MachineState, RopeMachine};
use crate::drive::{Drive, DriveState};
use crate::math::elementary::sin_cos;
use crate::reference;
use crate::system::{State, StateRef, StateShift, System};
use nalgebra::Vector2;

fn machine() -> Machine {
    Machine::new(reference::description(), 2).unwrap()
}

/// Returns the reference machine with three and with six coordinates per cylinder, and with twin ropes.
fn machines() -> [Machine; 3] {
    let twins = Machine::new(reference::twins([0.002, -0.003]), 2).unwrap();
    [machine(), machine().in_space(), twins]
}

/// Returns a state near the working position, perturbed in every coordinate so that no term vanishes.
pub(crate) fn disturbed(machine: &Machine) -> (Vec<f64>, Vec<f64>) {
    let layout = machine.layout;
    let law = reference::law();
    let drive = drive(0.0);
    let mut q = crate::settle::guess(machine, &machine.ropes(&law), &drive).unwrap();
    let mut v = vec![0.0; layout.len()];
    for i in free(machine) {
        let (s, c) = sin_cos(12.9898 * i as f64);
        q[i] += 1e-3 * s;
        v[i] += 0.05 * c;
    }
    (q, v)
}

#[test]
fn tangent_is_the_derivative_of_the_forces() {
    for machine in machines() {
        assert_tangent(&machine);
    }
}

fn assert_tangent(machine: &Machine) {
    let ropes = machine.ropes(&reference::law());
    let drive = drive(0.7);
    let layout = machine.layout;
    let (q, v) = disturbed(machine);
    let at = MachineState {
        ropes: &ropes,
        drive: &drive,
        q: &q,
        v: &v,
    };
    let mut scratch = ForceBuffers::new(machine);
    let mut force = vec![0.0; layout.len()];
    machine.forces(&at, &mut scratch, &mut force);
    let touching = |c: &Vec<f64>| c.iter().filter(|&&f| f > 0.0).count() > 3;
    assert!(scratch.chains.iter().all(|chain| touching(&chain.contact)));
    for (mu, gamma) in [(0.0, 0.0), (0.0, 40.0), (1600.0, 40.0)] {
        let mut matrix = layout.matrix();
        let shift = StateShift {
            mass: mu,
            damping: gamma,
        };
        machine.tangent(&at, shift, &scratch, (None, &mut matrix));
        for i in free(machine) {
            let column = matrix.product(&unit(layout.len(), i));
            let numeric = difference(machine, &at, i, gamma);
            let mut inertia = vec![0.0; layout.len()];
            machine.subtract_inertia(&q, &unit(layout.len(), i), &mut inertia);
            let scale = column.iter().map(|x| x.abs()).fold(0.0, f64::max);
            for r in 0..layout.len() {
                let expected = -numeric[r] - mu * inertia[r];
                assert!(
                    (expected - column[r]).abs() < 2e-6 * scale,
                    "mu {mu} gamma {gamma} row {} column {}: {expected} {}",
                    layout.describe(r),
                    layout.describe(i),
                    column[r]
                );
            }
        }
    }
}

fn drive(t: f64) -> DriveState {
    let drive = Drive {
        start: 1.0,
        ramp: 1.0,
        speed: 0.5,
    };
    machine().drive_state(&drive, t)
}

pub(crate) fn free(machine: &Machine) -> impl Iterator<Item = usize> {
    let layout = machine.layout;
    (0..layout.len()).filter(move |&i| !layout.is_locked(i))
}

/// Returns the central difference of the generalised forces with respect to coordinate `i`, whose rate is
/// changed by `gamma` times the change of the coordinate.
fn difference(machine: &Machine, at: &MachineState<'_>, i: usize, gamma: f64) -> Vec<f64> {
    let h = 1e-7;
    let step = |h: f64| {
        let (mut q, mut v) = (at.q.to_vec(), at.v.to_vec());
        q[i] += h;
        v[i] += gamma * h;
        let mut force = vec![0.0; q.len()];
        let moved = MachineState {
            q: &q,
            v: &v,
            ..*at
        };
        machine.forces(&moved, &mut ForceBuffers::new(machine), &mut force);
        force
    };
    let (plus, minus) = (step(h), step(-h));
    plus.iter()
        .zip(minus)
        .map(|(p, m)| (p - m) / (2.0 * h))
        .collect()
}

pub(crate) fn unit(n: usize, i: usize) -> Vec<f64> {
    let mut x = vec![0.0; n];
    x[i] = 1.0;
    x
}

#[test]
fn forces_are_the_gradient_of_the_potential() {
    for machine in machines() {
        assert_gradient(&machine);
    }
}

fn assert_gradient(machine: &Machine) {
    let mut law = reference::law();
    // torsion and bending must be equal for an exact potential out of plane
    law.bushing.rotational_stiffness = [308.0; 2];
    let ropes = machine.ropes(&law);
    let layout = machine.layout;
    let (q, _) = disturbed(machine);
    let v = vec![0.0; layout.len()];
    let mut drive = drive(0.0);
    drive.load = 0.0;
    let mut scratch = ForceBuffers::new(machine);
    let mut force = vec![0.0; layout.len()];
    machine.forces(
        &MachineState {
            ropes: &ropes,
            drive: &drive,
            q: &q,
            v: &v,
        },
        &mut scratch,
        &mut force,
    );
    let scale = force.iter().map(|x| x.abs()).fold(0.0, f64::max);
    for i in 0..layout.len() {
        let energy = |h: f64| {
            let mut q = q.clone();
            q[i] += h;
            let mut scratch = ForceBuffers::new(machine);
            let mut force = vec![0.0; layout.len()];
            machine.forces(
                &MachineState {
                    ropes: &ropes,
                    drive: &drive,
                    q: &q,
                    v: &v,
                },
                &mut scratch,
                &mut force,
            );
            machine.potential(
                &MachineState {
                    ropes: &ropes,
                    drive: &drive,
                    q: &q,
                    v: &v,
                },
                &scratch,
            )
        };
        let h = 1e-6;
        let numeric = -(energy(h) - energy(-h)) / (2.0 * h);
        assert!(
            (numeric - force[i]).abs() < 1e-6 * scale,
            "{}: {numeric} {}",
            layout.describe(i),
            force[i]
        );
    }
}

/// Checks the energy balance at a stationary crank: the power of all forces equals the rate of change of
/// stored energy plus dissipation, in a moving state with contact. Hence every force, including damping, has
/// its reaction.
#[test]
fn power_of_the_forces_is_what_is_stored_and_lost() {
    for machine in machines() {
        let mut law = reference::law();
        law.bushing.rotational_stiffness = [308.0; 2];
        let ropes = machine.ropes(&law);
        let mut drive = drive(0.0);
        drive.load = 0.0;
        drive.pin[1..].fill(Vector2::zeros());
        let (q, v) = disturbed(&machine);
        let evaluate = |t: f64| {
            let q: Vec<f64> = q.iter().zip(&v).map(|(q, v)| q + t * v).collect();
            let at = MachineState {
                ropes: &ropes,
                drive: &drive,
                q: &q,
                v: &v,
            };
            let mut scratch = ForceBuffers::new(&machine);
            let mut force = vec![0.0; q.len()];
            machine.forces(&at, &mut scratch, &mut force);
            let power: f64 = force.iter().zip(&v).map(|(force, v)| force * v).sum();
            let lost = machine.powers(&at, &v, &scratch).dissipated;
            (machine.potential(&at, &scratch), power, lost)
        };
        let h = 1e-6;
        let stored = (evaluate(h).0 - evaluate(-h).0) / (2.0 * h);
        let (_, power, lost) = evaluate(0.0);
        let missing = (power + stored + lost).abs();
        assert!(missing < 1e-3 * lost, "{power} + {stored} + {lost}");
    }
}

/// Returns, for each coordinate of a machine in the plane, its index in the same machine in space.
fn in_space(plane: &Machine) -> Vec<usize> {
    let layout = plane.layout;
    (0..layout.len())
        .map(|i| {
            if i >= layout.beam() {
                return i + layout.blocks() * 3;
            }
            (i / 3) * 6 + layout.motion.kept()[i % 3]
        })
        .collect()
}

/// Checks that three coordinates per cylinder give the same forces, tangent, energy and losses as six with
/// the remaining ones zero, in a moving state with contact.
#[test]
fn plane_and_space_agree() {
    assert_plane_is_space(&machine(), "");
}

/// Checks for a given machine, whose laws with memory have stored a previous state, that plane and space
/// agree as described in [`plane_and_space_agree`].
pub(crate) fn assert_plane_is_space(plane: &Machine, name: &str) {
    let space = plane.clone().in_space();
    let place = in_space(plane);
    let (q, v) = disturbed(plane);
    let lifted = |x: &[f64]| {
        let mut y = vec![0.0; space.layout.len()];
        for i in free(plane) {
            y[place[i]] = x[i];
        }
        y
    };
    let evaluate = |machine: &Machine, q: &[f64], v: &[f64]| {
        let drive = Drive {
            start: 1.0,
            ramp: 1.0,
            speed: 0.5,
        };
        let mut at = RopeMachine::new(machine, machine.ropes(&reference::law()), drive);
        let before = q.iter().map(|q| q * (1.0 + 1e-6)).collect();
        at.update_memory(&State::at_rest(0.6, before));
        let mut force = vec![0.0; q.len()];
        let mut matrix = machine.layout.matrix();
        let shift = StateShift {
            mass: 1600.0,
            damping: 40.0,
        };
        let mut at = System::new(at);
        let mut loads = at.forces(StateRef::new(0.7, q, v), &mut force);
        loads.tangent(shift, &mut matrix);
        let lost = loads.powers(v).dissipated;
        let energy = at.equations.energy(&State {
            v: v.to_vec(),
            ..State::at_rest(0.7, q.to_vec())
        });
        (force, matrix, energy, lost)
    };
    let (force, matrix, energy, lost) = evaluate(plane, &q, &v);
    let (force_6, matrix_6, energy_6, lost_6) = evaluate(&space, &lifted(&q), &lifted(&v));
    let close = |a: f64, b: f64, scale: f64| (a - b).abs() <= 1e-12 * scale;
    let largest = |x: &[f64]| x.iter().map(|x| x.abs()).fold(0.0, f64::max);
    let scale = largest(&force_6);
    for i in free(plane) {
        assert!(
            close(force[i], force_6[place[i]], scale),
            "{name} {}: {} {}",
            plane.layout.describe(i),
            force[i],
            force_6[place[i]]
        );
        let (column, column_6) = (
            matrix.product(&unit(q.len(), i)),
            matrix_6.product(&unit(space.layout.len(), place[i])),
        );
        let scale = largest(&column_6);
        for r in free(plane) {
            assert!(
                close(column[r], column_6[place[r]], scale),
                "{name} row {} column {}: {} {}",
                plane.layout.describe(r),
                plane.layout.describe(i),
                column[r],
                column_6[place[r]]
            );
        }
    }
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs();
    assert!(close(energy, energy_6), "{name}: {energy} {energy_6}");
    assert!(
        lost != 0.0 && close(lost, lost_6),
        "{name}: {lost} {lost_6}"
    );
}
