//! Nothing depends on where the world's axes lie.
use crate::rope::*;
use nalgebra::Rotation3;
use simulation::element::bushing::{Bushing, Marker};
use simulation::rig::{Drum, End, Rig, Setup};
use simulation::system::{Equations, System};

/// A bushing's load turns with the world, and does not know its origin.
#[test]
fn bushing_turns_with_the_world() {
    let law = Bushing {
        stiffness: [7.0, 3.0],
        damping: [0.9, 0.4],
        rotational_stiffness: [1.7, 2.3],
        rotational_damping: [0.6, 0.8],
    };
    let marker = |s: f64| Marker {
        p: V3::new(0.3 + s, -0.2 * s, 0.5),
        rho: V3::new(0.21, 0.1 * s, -0.15 * s),
        v: V3::new(0.3, 0.5 * s, -0.2),
        w: V3::new(-0.7 * s, 0.4, 0.9),
        R: Rotation3::new(V3::new(0.4 * s, -0.3, 0.6 + 0.2 * s)).into_inner(),
    };
    let turn = Rotation3::new(V3::new(0.7, -1.3, 2.1)).into_inner();
    let shift = V3::new(3.0, -7.0, 11.0);
    let moved = |m: &Marker| Marker {
        p: turn * m.p + shift,
        rho: turn * m.rho,
        v: turn * m.v,
        w: turn * m.w,
        R: turn * m.R,
    };
    let (i, j) = (marker(1.0), marker(1.4));
    let here = law.load(&i, &j);
    let there = law.load(&moved(&i), &moved(&j));
    assert!((turn * here.force - there.force).norm() < 1e-13);
    assert!((turn * here.torque_i - there.torque_i).norm() < 1e-13);
    assert!((turn * here.torque_j - there.torque_j).norm() < 1e-13);
    assert!((here.axial - there.axial).abs() < 1e-13);
    assert!((here.dissipated - there.dissipated).abs() < 1e-13);
    assert!((law.energy(&i, &j) - law.energy(&moved(&i), &moved(&j))).abs() < 1e-13);
}

/// A whole rig in motion, contact and dead loads included, turned about z and moved: forces on the
/// centres turn along, forces on the angles and the energy stay.
#[test]
fn rig_turns_with_the_world() {
    let (alpha, shift) = (0.7_f64, V3::new(3.0, -2.0, 1.0));
    let turn = Rotation3::new(V3::new(0.0, 0.0, alpha)).into_inner();
    let build = |moved: bool| {
        let point = |x: V3| if moved { turn * x + shift } else { x };
        let direction = |x: V3| if moved { turn * x } else { x };
        let center = point(V3::new(0.3, -1.9, 0.0));
        Setup {
            gravity: direction(V3::new(0.0, -9.81, 0.0)),
            ends: [
                End::Held {
                    place: point(V3::zeros()),
                    angle: if moved { alpha } else { 0.0 },
                    law: soft().bushing,
                },
                End::Free {
                    force: direction(V3::new(30.0, -70.0, 11.0)),
                    twist: 0.4,
                    turn: -0.3,
                },
            ],
            drum: Some(Drum {
                center: [center.x, center.y],
                radius: 1.902,
                law: optimised().contact,
            }),
            ..cantilever(12, soft().bushing)
        }
    };
    let evaluate = |moved: bool| {
        let mut system = System::new(Rig::new(build(moved)));
        let mut q = Rig::new(build(false)).straight(V3::zeros(), 0.0);
        let mut v = vec![0.0; q.len()];
        for i in 0..q.len() {
            q[i] += 1e-3 * (12.9898 * i as f64).sin();
            v[i] = 0.3 * (78.233 * i as f64).cos();
        }
        if moved {
            for (q, v) in q.chunks_exact_mut(6).zip(v.chunks_exact_mut(6)) {
                let p = turn * V3::new(q[0], q[1], q[2]) + shift;
                q[..3].copy_from_slice(p.as_slice());
                q[5] += alpha;
                let speed = turn * V3::new(v[0], v[1], v[2]);
                v[..3].copy_from_slice(speed.as_slice());
            }
        }
        let mut force = vec![0.0; q.len()];
        system.forces(0.0, &q, &v, &mut force);
        let touching = system.equations.state.contact.iter().any(|&f| f > 0.0);
        assert!(touching);
        let lost = system.equations.powers(0.0, &q, &v, &v).dissipated;
        (force, system.equations.energy(&q, &v), lost)
    };
    let (here, energy, lost) = evaluate(false);
    let (there, moved_energy, moved_lost) = evaluate(true);
    let scale = here.iter().map(|x| x.abs()).fold(0.0, f64::max);
    for (a, b) in here.chunks_exact(6).zip(there.chunks_exact(6)) {
        let turned = turn * V3::new(a[0], a[1], a[2]);
        for k in 0..3 {
            assert!((turned[k] - b[k]).abs() < 1e-8 * scale);
            assert!((a[3 + k] - b[3 + k]).abs() < 1e-8 * scale);
        }
    }
    assert!(
        (lost / moved_lost - 1.0).abs() < 1e-9,
        "{lost} {moved_lost}"
    );
    // potentials of weight and of dead loads are counted from the origin of W
    let weight = build(true);
    let total = weight.gravity * (weight.chain.mass * 12.0);
    let pull = turn * V3::new(30.0, -70.0, 11.0);
    let offset = -(total + pull).dot(&shift) + 0.3 * alpha;
    assert!(
        (moved_energy - energy - offset).abs() < 1e-8 * energy.abs(),
        "{energy} {moved_energy}"
    );
}
