use super::{Instant, Machine, Scratch};
use crate::drive::Drive;
use crate::linear::Bordered;
use crate::math::elementary::sin_cos;
use crate::reference;

fn machine() -> Machine {
    Machine::new(reference::description(), 2).unwrap()
}

/// A state near the working position, disturbed in every coordinate so that nothing vanishes.
fn disturbed(machine: &Machine) -> (Vec<f64>, Vec<f64>) {
    let layout = machine.layout;
    let law = reference::law();
    let drive = Drive {
        start: 1.0,
        ramp: 1.0,
        speed: 0.5,
    };
    let mut q =
        crate::settle::guess(machine, &machine.ropes(&law), &drive.state(machine, 0.0)).unwrap();
    let mut v = vec![0.0; layout.len()];
    for i in 0..layout.len() {
        let locked =
            (i / 6 == 0 || i / 6 == layout.base_block(1)) && i % 6 > 0 && i < layout.beam();
        if locked {
            continue;
        }
        let (s, c) = sin_cos(12.9898 * i as f64);
        q[i] += 1e-3 * s;
        v[i] += 0.05 * c;
    }
    (q, v)
}

#[test]
#[expect(
    clippy::too_many_lines,
    reason = "one column after the other, all in one place"
)]
fn tangent_is_the_derivative_of_the_forces() {
    let machine = machine();
    let ropes = machine.ropes(&reference::law());
    let layout = machine.layout;
    let (q, v) = disturbed(&machine);
    let drive = Drive {
        start: 1.0,
        ramp: 1.0,
        speed: 0.5,
    }
    .state(&machine, 0.7);
    let mut scratch = Scratch::new(&layout);
    let mut force = vec![0.0; layout.len()];
    machine.forces(
        &Instant {
            ropes: &ropes,
            drive: &drive,
            q: &q,
            v: &v,
        },
        &mut scratch,
        &mut force,
    );
    for state in &scratch.chains {
        assert!(state.contact.iter().filter(|&&f| f > 0.0).count() > 3);
    }
    for (mu, gamma) in [(0.0, 0.0), (0.0, 40.0), (1600.0, 40.0)] {
        let mut matrix = Bordered::new(&layout.chains(), 1 + layout.modes);
        machine.tangent(
            &Instant {
                ropes: &ropes,
                drive: &drive,
                q: &q,
                v: &v,
            },
            (mu, gamma),
            &scratch,
            &mut matrix,
        );
        // the derivative of Q along (dq, gamma dq), one coordinate at a time
        let mut worst: (f64, String) = (0.0, String::new());
        for i in 0..layout.len() {
            if matrix
                .product(&unit(layout.len(), i))
                .iter()
                .filter(|x| **x != 0.0)
                .count()
                == 1
                && i < layout.beam()
            {
                continue; // locked
            }
            let h = 1e-7;
            let step = |h: f64| {
                let (mut q, mut v) = (q.clone(), v.clone());
                q[i] += h;
                v[i] += gamma * h;
                let mut force = vec![0.0; layout.len()];
                machine.forces(
                    &Instant {
                        ropes: &ropes,
                        drive: &drive,
                        q: &q,
                        v: &v,
                    },
                    &mut Scratch::new(&layout),
                    &mut force,
                );
                force
            };
            let (plus, minus) = (step(h), step(-h));
            let column = matrix.product(&unit(layout.len(), i));
            let mut inertia = vec![0.0; layout.len()];
            machine.subtract_inertia(&q, &unit(layout.len(), i), &mut inertia);
            let scale = column.iter().map(|x| x.abs()).fold(0.0, f64::max);
            for r in 0..layout.len() {
                let numeric = -(plus[r] - minus[r]) / (2.0 * h) - mu * inertia[r];
                let error = (numeric - column[r]).abs() / scale;
                if error > worst.0 {
                    worst = (
                        error,
                        format!(
                            "row {} column {}: {numeric} {}",
                            layout.describe(r),
                            layout.describe(i),
                            column[r]
                        ),
                    );
                }
            }
        }
        assert!(
            worst.0 < 2e-6,
            "mu {mu} gamma {gamma}: {} {}",
            worst.0,
            worst.1
        );
    }
}

fn unit(n: usize, i: usize) -> Vec<f64> {
    let mut x = vec![0.0; n];
    x[i] = 1.0;
    x
}

#[test]
fn forces_are_the_gradient_of_the_potential() {
    let machine = machine();
    let mut law = reference::law();
    // torsion and bending must be equal for an exact potential out of plane
    law.bushing.rotational_stiffness = [308.0; 2];
    let ropes = machine.ropes(&law);
    let layout = machine.layout;
    let (q, _) = disturbed(&machine);
    let v = vec![0.0; layout.len()];
    let mut drive = Drive {
        start: 1.0,
        ramp: 1.0,
        speed: 0.5,
    }
    .state(&machine, 0.0);
    drive.load = 0.0;
    let mut scratch = Scratch::new(&layout);
    let mut force = vec![0.0; layout.len()];
    machine.forces(
        &Instant {
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
            let mut scratch = Scratch::new(&layout);
            let mut force = vec![0.0; layout.len()];
            machine.forces(
                &Instant {
                    ropes: &ropes,
                    drive: &drive,
                    q: &q,
                    v: &v,
                },
                &mut scratch,
                &mut force,
            );
            machine.potential(
                &Instant {
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
