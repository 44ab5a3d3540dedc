//! Tests of small vibrations about equilibrium, from the tangent and in the time domain.
use crate::rope::*;
use simulation::rig::{End, Rig, Setup};
use simulation::system::{Equations, StateRef, System};
use std::f64::consts::PI;

/// Computes the lowest in-plane modes as (angular frequency, shape), by inverse iteration on `-K x = w^2 M
/// x`.
fn modes(system: &mut System<Rig>, q: &[f64], count: usize, along: usize) -> Vec<(f64, Vec<f64>)> {
    let n = q.len();
    let still = vec![0.0; n];
    let mut force = vec![0.0; n];
    let mut loads = system.forces(StateRef::new(0.0, q, &still), &mut force);
    loads.factorize_static(0.0).unwrap();
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let mass = |x: &[f64]| {
        let mut out = vec![0.0; n];
        system.equations.subtract_inertia(q, x, &mut out);
        out.iter().map(|x| -x).collect::<Vec<f64>>()
    };
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    for k in 0..count {
        let mut x = vec![0.0; n];
        for j in 0..n / 6 {
            x[6 * j + along] = (1.0 + (k + 1) as f64 * 0.37 * j as f64).sin();
        }
        let mut square = 0.0;
        for _ in 0..200 {
            let mut next = mass(&x);
            system.solve(&mut next);
            for (_, shape) in &found {
                let part = dot(&mass(&next), shape);
                for (x, s) in next.iter_mut().zip(shape) {
                    *x -= part * s;
                }
            }
            let size = dot(&mass(&next), &next).sqrt();
            for x in &mut next {
                *x /= size;
            }
            square = 1.0 / size;
            x = next;
        }
        found.push((square.sqrt(), x));
    }
    found
}

fn hanging(count: usize) -> (System<Rig>, Vec<f64>) {
    // the same rope of 3 m whatever the number of cylinders
    let pitch = 3.0 / count as f64;
    let law = string().scaled(0.05 / pitch);
    let mut setup = Setup {
        gravity: V3::new(0.0, -9.81, 0.0),
        ends: [
            End::Held {
                place: V3::zeros(),
                angle: -0.5 * PI,
                law: pinned(&law),
            },
            End::free(),
        ],
        ..cantilever(count, law)
    };
    setup.chain = simulation::model::chain::Chain::solid(0, count, 0.01, pitch, 7850.0);
    let q = Rig::new(setup).straight(V3::zeros(), -0.5 * PI);
    settled(&setup, q)
}

/// Checks that a hanging rope swings at `w_n = j_n / 2 sqrt(g / L)`, `j_n` the zeros of Bessel's `J_0`; twice
/// as many cylinders divide the error by four.
#[test]
fn hanging_rope_swings_at_the_bessel_zeros() {
    let zeros = [
        2.404825557695773,
        5.520078110286311,
        8.653727912911013,
        11.79153443901428,
    ];
    let errors = |count: usize| -> Vec<f64> {
        let (mut system, q) = hanging(count);
        modes(&mut system, &q, zeros.len(), 0)
            .iter()
            .zip(zeros)
            .map(|((w, _), j)| w / (0.5 * j * (9.81_f64 / 3.0).sqrt()) - 1.0)
            .collect()
    };
    let [coarse, middle, fine] = [15, 30, 60].map(errors);
    eprintln!("hanging rope: {coarse:?} {middle:?} {fine:?}");
    // what 60 cylinders leave, mode by mode, and the rope's own stretch of 1e-4
    for (k, allowed) in [2e-4, 5e-4, 2e-3, 5e-3].into_iter().enumerate() {
        assert!(fine[k].abs() < allowed, "mode {k}: {}", fine[k]);
    }
    for k in 1..zeros.len() {
        let order = ((coarse[k] - middle[k]) / (middle[k] - fine[k])).log2();
        eprintln!("mode {k}: spatial order {order:.3}");
        assert!((order - 2.0).abs() < 0.3, "mode {k}: spatial order {order}");
    }
}

/// Checks the hanging rope's first period in the time domain: half a period lies between consecutive zero
/// crossings.
#[test]
fn hanging_rope_keeps_its_period_in_time() {
    let (mut system, q) = hanging(60);
    let (w, shape) = modes(&mut system, &q, 1, 0).swap_remove(0);
    let v: Vec<f64> = shape.iter().map(|s| 0.01 * s).collect();
    let mut state = started(&mut system, q, v);
    let tip = 59 * 6;
    let mut crossings = Vec::new();
    let course = Course {
        longest: 0.01,
        ..Course::accurate(0.01)
    };
    let until = 3.2 * PI / w;
    advance(&mut system, &course, &mut state, until, |from, to, _| {
        let (a, b) = (from.q[tip], to.q[tip]);
        if a * b < 0.0 && from.t > 0.0 {
            crossings.push(from.t + (to.t - from.t) * a / (a - b));
        }
    });
    eprintln!("half periods {:?} of {}", crossings, PI / w);
    assert_eq!(crossings.len(), 3);
    for (k, t) in crossings.iter().enumerate() {
        let expected = (k + 1) as f64 * PI / w;
        assert!((t / expected - 1.0).abs() < 1e-4, "{t} for {expected}");
    }
}

/// Checks the harmonics of a string under tension: `f_n = n / (2 L) sqrt(T / m)` with m its mass per length.
#[test]
fn taut_string_sounds_its_harmonics() {
    let (count, tension) = (80_usize, 200.0);
    let law = string();
    let stretch = tension / law.stiffness[0] * (count + 1) as f64;
    let length = 0.05 * count as f64 + stretch;
    let setup = strung(count, law, length, 0.0);
    let (mut system, q) = settled_straight(&setup);
    assert!((system.equations.state.tension(40) / tension - 1.0).abs() < 1e-9);
    let per_length = setup.chain.mass * count as f64 / length;
    for (n, (w, _)) in modes(&mut system, &q, 5, 1).iter().enumerate() {
        let expected = (n + 1) as f64 * PI / length * (tension / per_length).sqrt();
        eprintln!("string {}: {:.2e}", n + 1, w / expected - 1.0);
        assert!(
            (w / expected - 1.0).abs() < 2e-3,
            "harmonic {}: {w} {expected}",
            n + 1
        );
    }
}
