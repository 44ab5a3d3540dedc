//! Tests of derivatives of equilibria by the implicit function theorem, as the columns of a run compute them:
//! one exact factorisation, and as right side the forces of ropes in which only one coefficient is non-zero
//! (for the rope length, a difference of forces at fixed coordinates). Expected values are those of
//! cantilever, string and catenary.
use crate::rope::*;
use simulation::element::bushing::Bushing;
use simulation::rig::{End, Rig, Setup};
use simulation::system::{Equations, StateRef, StateShift, System};
use std::f64::consts::LN_10;

/// Joint without stiffness, damping and preload.
const NONE: Bushing = Bushing {
    stiffness: [0.0; 2],
    damping: [0.0; 2],
    rotational_stiffness: [0.0; 2],
    rotational_damping: [0.0; 2],
    preload: 0.0,
};

/// Returns a rig's setup with its joint laws replaced by the result of `law` and its loads multiplied by
/// `share`.
fn with(setup: &Setup, law: fn(&Bushing) -> Bushing, share: f64) -> Setup {
    let end = |end: &End| match *end {
        End::Held {
            place,
            angle,
            law: own,
        } => End::Held {
            place,
            angle,
            law: law(&own),
        },
        End::Free { force, twist, turn } => End::Free {
            force: force * share,
            twist: twist * share,
            turn: turn * share,
        },
    };
    Setup {
        gravity: setup.gravity * share,
        joint: law(&setup.joint),
        ends: [end(&setup.ends[0]), end(&setup.ends[1])],
        ..*setup
    }
}

fn axial(law: &Bushing) -> Bushing {
    Bushing {
        stiffness: [law.stiffness[0], 0.0],
        ..NONE
    }
}

fn shear(law: &Bushing) -> Bushing {
    Bushing {
        stiffness: [0.0, law.stiffness[1]],
        ..NONE
    }
}

fn bending(law: &Bushing) -> Bushing {
    Bushing {
        rotational_stiffness: [0.0, law.rotational_stiffness[1]],
        ..NONE
    }
}

/// Returns the derivative of an equilibrium's coordinates with respect to the decimal logarithm of a common
/// factor of some of the rig's forces, namely those contained in the setup `part`.
fn column(system: &mut System<Rig>, q: &[f64], part: &Setup) -> Vec<f64> {
    let still = vec![0.0; q.len()];
    let at = StateRef::new(0.0, q, &still);
    let mut right = still.clone();
    System::new(Rig::new(*part)).forces(at, &mut right);
    let right = solved(system, at, right);
    right.iter().map(|x| LN_10 * x).collect()
}

/// Returns the derivative of an equilibrium's coordinates per metre of cylinder length, from central
/// differences of the forces at fixed coordinates.
fn by_pitch(system: &mut System<Rig>, q: &[f64], setup: &Setup) -> Vec<f64> {
    const STEP: f64 = 1e-6;
    let still = vec![0.0; q.len()];
    let at = StateRef::new(0.0, q, &still);
    let force = |step: f64| {
        let mut longer = *setup;
        longer.chain.pitch += step;
        let mut force = still.clone();
        System::new(Rig::new(longer)).forces(at, &mut force);
        force
    };
    let (more, less) = (force(STEP), force(-STEP));
    let right = more.iter().zip(&less).map(|(x, y)| (x - y) / (2.0 * STEP));
    solved(system, at, right.collect())
}

/// Solves a linear system with the exact tangent factorised at an equilibrium.
fn solved(system: &mut System<Rig>, at: StateRef<'_>, mut right: Vec<f64>) -> Vec<f64> {
    let mut force = vec![0.0; right.len()];
    let mut factor = system.equations.matrix();
    let mut loads = system.forces(at, &mut force);
    let still = vec![0.0; right.len()];
    loads.exact_tangent(&still, StateShift::NONE, &mut factor);
    factor.factorize().unwrap();
    factor.solve(&mut right);
    right
}

fn close(found: f64, expected: f64, share: f64, what: &str) {
    eprintln!("{what}: {found:e}, {expected:e}");
    assert!((found / expected - 1.0).abs() < share, "{what}");
}

/// Checks the derivatives of a cantilever's tip deflection `w = F sum (L - x_j)^2 / K_55 + n F / K_22`,
/// summed over the joints at `x_j`.
#[test]
fn cantilever_by_bending_by_shear_by_load_and_by_length() {
    let (count, load) = (20, 1e-3);
    let mut setup = cantilever(count, recommended().bushing);
    setup.ends[1] = End::Free {
        force: V3::new(0.0, load, 0.0),
        twist: 0.0,
        turn: 0.0,
    };
    let straight = Rig::new(setup).straight(V3::zeros(), 0.0);
    let (mut system, q) = settled(&setup, straight);
    let law = setup.joint;
    let arm = |j: usize| 0.05 * (count - j) as f64;
    let bent: f64 = (0..count).map(|j| arm(j) * arm(j)).sum();
    let by_bending = load * bent / law.rotational_stiffness[1];
    let by_shear = load * count as f64 / law.stiffness[1];
    let last = 6 * (count - 1);
    let tip = |x: &[f64]| x[last + 1] + 0.025 * x[last + 5];
    let mut of = |part: &Setup| tip(&column(&mut system, &q, part));
    let found = of(&with(&setup, bending, 0.0));
    close(found, -LN_10 * by_bending, 1e-6, "bending");
    let found = of(&with(&setup, shear, 0.0));
    close(found, -LN_10 * by_shear, 1e-3, "shear");
    let found = of(&with(&setup, |_| NONE, 1.0));
    close(found, LN_10 * (by_bending + by_shear), 1e-6, "load");
    let longer = by_pitch(&mut system, &q, &setup);
    // the tip lies half a cylinder beyond its centre
    let found = tip(&longer) + 0.5 * q[last + 5];
    close(found, 2.0 * by_bending / 0.05, 1e-6, "length");
}

/// Checks the derivatives of a taut string's sag, which is its weight over its tension; the tension is `K_11`
/// times the joint stretch.
#[test]
fn string_by_stiffness_by_load_and_by_length() {
    let (count, stretch) = (41, 1e-3);
    let law = string();
    let span = 0.05 * count as f64 + stretch * (count + 1) as f64;
    let setup = strung(count, law, span, 0.0981);
    let q = (0..count).flat_map(|j| {
        let x = 0.025 + stretch + (0.05 + stretch) * j as f64;
        [x, 0.0, 0.0, 0.0, 0.0, 0.0]
    });
    let (mut system, q) = settled(&setup, q.collect());
    let middle = 6 * (count / 2) + 1;
    let weight = setup.chain.mass * 0.0981 * count as f64 / span;
    let sag = -weight * span * span / (8.0 * law.stiffness[0] * stretch);
    close(q[middle], sag, 1e-3, "sag");
    let found = column(&mut system, &q, &with(&setup, axial, 0.0))[middle];
    // the tension's share of the shear stiffness is 1e-3
    close(found, -LN_10 * q[middle], 2e-3, "stiffness");
    let found = column(&mut system, &q, &with(&setup, |_| NONE, 1.0))[middle];
    close(found, LN_10 * q[middle], 1e-3, "load");
    // a longer string is stretched less: n cylinders share what the span leaves to n + 1 joints
    let found = by_pitch(&mut system, &q, &setup)[middle];
    let slack = count as f64 / ((count + 1) as f64 * stretch);
    close(found, sag * slack, 3e-3, "length");
}

/// Checks the derivatives of a hanging string: scaling stiffnesses and loads alike leaves its shape
/// unchanged, and axial stretch increases the sag by `d sag / d S` of the catenary of length `S`.
#[test]
fn catenary_by_stiffness_by_load_and_by_length() {
    let (count, span) = (100, 4.0_f64);
    let law = string();
    let setup = strung(count, law, span, 9.81);
    let (mut system, q) = settled(&setup, bowed(count, span));
    let mut of = |part: &Setup| column(&mut system, &q, part);
    let by_axial = of(&with(&setup, axial, 0.0));
    let by_load = of(&with(&setup, |_| NONE, 1.0));
    let others = [shear, bending].map(|part| of(&with(&setup, part, 0.0)));
    let size = by_axial.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
    for (i, (load, axial)) in by_load.iter().zip(&by_axial).enumerate() {
        let rest = load + axial + others[0][i] + others[1][i];
        assert!(rest.abs() < 1e-6 * size, "{i}: {rest:e} of {size:e}");
    }
    // the catenary of this length
    let length = 0.05 * count as f64;
    let of_length = |a: f64| 2.0 * a * (0.5 * span / a).sinh();
    let sag = |a: f64| a * ((0.5 * span / a).cosh() - 1.0);
    let (mut low, mut high) = (0.1, 10.0);
    for _ in 0..200 {
        let a = 0.5 * (low + high);
        (low, high) = if of_length(a) > length {
            (a, high)
        } else {
            (low, a)
        };
    }
    let (a, h) = (low, 1e-5);
    let slope = (sag(a + h) - sag(a - h)) / (of_length(a + h) - of_length(a - h));
    let state = &system.equations.state;
    let tension: f64 = (0..=count).map(|j| state.tension(j)).sum();
    let middle = 6 * (count / 2) + 1;
    let expected = LN_10 * slope * tension / law.stiffness[0];
    close(by_axial[middle], expected, 0.01, "stiffness");
    let found = by_pitch(&mut system, &q, &setup)[middle];
    close(found, -slope * count as f64, 0.01, "length");
}
