//! Test of frame invariance: results do not depend on the position and direction of the world's axes.
use crate::rope::*;
use nalgebra::Rotation3;
use simulation::rig::{Drum, End, Rig, Setup};
use simulation::system::{StateRef, System};

/// Checks that turning a moving rig, with contact and dead loads, about z and shifting it turns the forces on
/// the cylinder centres by the same angle and leaves the forces on the angles and the energy unchanged.
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
        let loads = system.forces(StateRef::new(0.0, &q, &v), &mut force);
        let touching = loads.equations().state.contact.iter().any(|&f| f > 0.0);
        assert!(touching);
        let lost = loads.powers(&v).dissipated;
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
