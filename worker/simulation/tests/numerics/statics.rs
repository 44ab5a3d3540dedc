//! Tests of ropes at rest.
use crate::rope::*;
use simulation::element::bushing::Bushing;
use simulation::rig::{Drum, End, Setup};

/// Checks that a string of 100 cylinders between two pins at one height hangs as a catenary.
///
/// `y = a cosh(x / a)` with `S = 2 a sinh(b / 2 a)` for the stretched length S and the span b, and the
/// horizontal tension `H = w a` for the weight w per length.
#[test]
fn hanging_string_is_a_catenary() {
    catenary(&string());
}

/// Checks that a preload of 300 N in the unstretched joints, which shortens the string by 0.6 % (its weight
/// stretches it by 0.02 %), gives the catenary of the shorter length with the corresponding horizontal
/// tension.
#[test]
fn preloaded_string_is_the_catenary_of_a_shorter_one() {
    catenary(&Bushing {
        preload: 300.0,
        ..string()
    });
}

fn catenary(law: &Bushing) {
    let (count, span, length) = (100, 4.0_f64, 5.0_f64);
    let law = *law;
    let setup = strung(count, law, span, 9.81);
    let (system, q) = settled(&setup, bowed(count, span));

    // the string stretches by the mean of its tension, w sqrt(a^2 + s^2): 2e-4 of its length
    let weight = setup.chain.mass * 9.81 / 0.05;
    let (mut a, mut stretched) = (1.0_f64, length);
    for _ in 0..20 {
        let (mut low, mut high) = (0.1, 10.0);
        for _ in 0..200 {
            a = 0.5 * (low + high);
            if 2.0 * a * f64::sinh(span / (2.0 * a)) > stretched {
                low = a;
            } else {
                high = a;
            }
        }
        let s = 0.5 * length;
        let tension = weight * (s * s.hypot(a) + a * a * (s / a).asinh());
        let drawn = (count + 1) as f64 * law.preload;
        stretched = length + (tension / 0.05 - drawn) / law.stiffness[0];
    }
    // the weight is that of the unstretched string
    let horizontal = weight * length / stretched * a;
    let height = |x: f64| a * (((x - 0.5 * span) / a).cosh() - (0.5 * span / a).cosh());
    let sag = -height(0.5 * span);
    // joints lie on the curve of the string; a cylinder's middle lies above its chord's ends
    let worst = (0..count - 1)
        .map(|j| {
            let joint = system.equations.outer_end(j);
            (joint.y - height(joint.x)).abs()
        })
        .fold(0.0, f64::max);
    let pull = system.equations.state.joints[count / 2].force.x.abs();
    eprintln!(
        "catenary: {worst:.2e} of {sag:.4} m, pull {:.2e}",
        pull / horizontal - 1.0
    );
    assert!(worst < 5e-4 * sag, "{worst} of {sag}");
    assert!((pull / horizontal - 1.0).abs() < 1e-3);
    assert!(q.iter().all(|x| x.is_finite()));
}

/// Checks that a rope pulled over a drum presses on it with `T / R` per length, whatever its coefficients.
///
/// Uses ten cylinders in the middle of half a turn, far from both ends, where bending is constant.
#[test]
fn wrapped_rope_presses_with_tension_over_radius() {
    for (law, pull) in [
        (recommended(), 1e4),
        (recommended(), 5e4),
        (optimised(), 1e4),
        (optimised(), 5e4),
    ] {
        let radius = 1.205;
        let setup = Setup {
            ends: [
                End::Held {
                    place: V3::new(0.0, radius, 0.0),
                    angle: 0.0,
                    law: law.bushing,
                },
                End::Free {
                    force: V3::new(-pull, 0.0, 0.0),
                    twist: 0.0,
                    turn: 0.0,
                },
            ],
            drum: Some(Drum {
                center: [0.0; 2],
                radius,
                law: law.contact,
            }),
            ..cantilever(100, law.bushing)
        };
        let (system, q) = settled(
            &setup,
            crate::reference::laid_on_drum(100, std::f64::consts::PI),
        );
        let state = &system.equations.state;
        let mut worst: f64 = 0.0;
        for j in 34..44 {
            let at = q[6 * j].hypot(q[6 * j + 1]);
            let tension = 0.5 * (state.tension(j) + state.tension(j + 1));
            let pitch = 0.05 + tension / law.bushing.stiffness[0];
            let pressure = state.contact[j] / pitch;
            worst = worst.max((pressure / (tension / at) - 1.0).abs());
        }
        eprintln!("wrap pressure at {pull} N: {worst:.2e}");
        assert!(worst < 2e-3, "{pull}: {worst}");
    }
}
