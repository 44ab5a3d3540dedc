//! Tests of a cylinder bouncing on the IMPACT contact law.
use crate::rope::*;
use simulation::element::impact::Impact;
use simulation::rig::{Drum, End, Rig, Setup};
use simulation::system::System;

struct Bounce {
    depth: f64,
    duration: f64,
    returned: f64,
}

fn bounce(law: Impact, speed: f64) -> Bounce {
    // a floor: so large a drum that all contact points of a cylinder sink in alike
    let radius = 1e5;
    let setup = Setup {
        ends: [End::free(), End::free()],
        drum: Some(Drum {
            center: [0.0, -radius],
            radius,
            law,
        }),
        ..cantilever(1, recommended().bushing)
    };
    let mut system = System::new(Rig::new(setup));
    let q = vec![0.0, 1e-5, 0.0, 0.0, 0.0, 0.0];
    let v = vec![0.0, -speed, 0.0, 0.0, 0.0, 0.0];
    let mut state = started(&mut system, q, v);
    let course = Course {
        longest: 2e-6,
        ..Course::accurate(1e-5)
    };
    let (mut depth, mut touched, mut left) = (0.0_f64, 0.0, 0.0);
    advance(&mut system, &course, &mut state, 12e-3, |from, to, _| {
        depth = depth.max(-to.q[1]);
        let (a, b) = (from.q[1], to.q[1]);
        let crossing = from.t + (to.t - from.t) * a / (a - b);
        if a > 0.0 && b <= 0.0 {
            touched = crossing;
        } else if a <= 0.0 && b > 0.0 {
            left = crossing;
        }
    });
    Bounce {
        depth,
        duration: left - touched,
        returned: state.v[1],
    }
}

/// Checks an undamped bounce against Hertz's solution: a body of mass m that hits a spring `K d^1.5` at speed
/// v reaches the depth `d = (5 m v^2 / 4 K)^(2/5)`, leaves after `2.9432 d / v`, and rebounds at the speed of
/// impact.
#[test]
fn undamped_bounce_is_hertzs() {
    let mass = chain(1).mass;
    for (stiffness, speed) in [(4.01e8, 1.0), (4.01e8, 0.3), (1e7, 0.5)] {
        let law = Impact {
            stiffness,
            exponent: 1.5,
            damping: 0.0,
            full_damping_penetration: 1e-4,
        };
        let depth = (1.25 * mass * speed * speed / stiffness).powf(0.4);
        let found = bounce(law, speed);
        let errors = [
            found.depth / depth - 1.0,
            found.duration / (2.943_275 * depth / speed) - 1.0,
            found.returned / speed - 1.0,
        ];
        eprintln!("bounce {stiffness:.0e} {speed}: {errors:?}");
        assert!(errors.iter().all(|e| e.abs() < 1e-3), "{errors:?}");
    }
}

/// Computes the rebound speed with 200,000 Runge-Kutta steps of `m d'' = -f(d, d')`, with the contact law
/// written out independently.
fn returned_by_runge_kutta(law: &Impact, mass: f64, speed: f64, duration: f64) -> f64 {
    let force = |d: f64, rate: f64| {
        if d <= 0.0 {
            return 0.0;
        }
        let u = (d / law.full_damping_penetration).min(1.0);
        let damping = law.damping * u * u * (3.0 - 2.0 * u);
        (law.stiffness * d.powf(law.exponent) + damping * rate).max(0.0)
    };
    let steps = 200_000;
    let h = duration / f64::from(steps);
    let (mut d, mut v) = (0.0, speed);
    for _ in 0..steps {
        let f = |d: f64, v: f64| (v, -force(d, v) / mass);
        let k1 = f(d, v);
        let k2 = f(d + 0.5 * h * k1.0, v + 0.5 * h * k1.1);
        let k3 = f(d + 0.5 * h * k2.0, v + 0.5 * h * k2.1);
        let k4 = f(d + h * k3.0, v + h * k3.1);
        d += h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
        v += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
    }
    -v
}

/// Checks the restitution with the paper's optimised and recommended contact damping against the scalar
/// equation of motion.
#[test]
fn damped_bounce_has_the_restitution_of_its_scalar_equation() {
    for (law, speed) in [
        (optimised().contact, 1.0),
        (optimised().contact, 0.2),
        (recommended().contact, 0.5),
    ] {
        let found = bounce(law, speed).returned;
        let expected = returned_by_runge_kutta(&law, chain(1).mass, speed, 12e-3);
        let restitution = expected / speed;
        eprintln!(
            "restitution {restitution:.4}: {:.2e}",
            (found - expected) / speed
        );
        assert!(restitution > 0.0 && restitution < 0.99);
        assert!(
            (found - expected).abs() < 1e-3 * speed,
            "{found} {expected}"
        );
    }
}
