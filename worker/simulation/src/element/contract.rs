//! Contract tests of the joints between and at the ends of rope cylinders: tangent, action and reaction,
//! power balance, independence of the frame.
use super::bushing::{AxialTension, Bushing, LinkLoad, Marker};
use nalgebra::{Matrix3, Rotation3, Vector3};

type V3 = Vector3<f64>;
type M3 = Matrix3<f64>;

fn rotation(theta: &V3) -> M3 {
    Rotation3::new(*theta).into_inner()
}

/// Returns pairs of markers (I, J) in general relative motion, without any symmetry.
fn motions() -> Vec<[Marker; 2]> {
    let marker = |s: f64, depth: f64| Marker {
        p: V3::new(0.3 + s - depth, -0.2 * s, 0.5),
        rho: V3::new(0.21, 0.1 * s, -0.15 * s),
        v: V3::new(0.3 - 0.6 * depth, 0.5 * s, -0.2),
        w: V3::new(-0.7 * s, 0.4, 0.9),
        R: rotation(&V3::new(0.4 * s, -0.3, 0.6 + 0.2 * s)),
    };
    let pairs = [0.1, 0.5, 1.1].map(|depth| [marker(1.0, depth), marker(1.4, 0.0)]);
    pairs.to_vec()
}

/// Changes one component of the motion of a marker's body by `h`: position, velocity, rotation or angular
/// velocity. A rotation also turns the marker's offset and axes.
fn moved(m: &Marker, kind: usize, k: usize, h: f64) -> Marker {
    let mut d = V3::zeros();
    d[k] = h;
    let mut m = *m;
    match kind {
        0 => m.p += d,
        1 => m.v += d,
        2 => {
            let turn = rotation(&d);
            m.rho = turn * m.rho;
            m.R = turn * m.R;
        }
        _ => m.w += d,
    }
    m
}

const BUSHING: Bushing = Bushing {
    stiffness: [7.0, 3.0],
    damping: [0.9, 0.4],
    rotational_stiffness: [1.7, 2.3],
    rotational_damping: [0.6, 0.8],
    preload: 0.35,
};

/// Returns the joint laws under test: between two cylinders, at a rope's ends, and one with equal torsional
/// and bending stiffness, for which the static forces derive exactly from the energy.
fn joints() -> [(&'static str, Bushing); 4] {
    let round = Bushing {
        rotational_stiffness: [2.3; 2],
        ..BUSHING
    };
    [
        ("between cylinders", BUSHING),
        ("revolute", BUSHING.revolute()),
        ("pinned", BUSHING.pinned()),
        ("alike all round", round),
    ]
}

/// Calls `check` with every joint law that `of` selects, in every motion of [`motions`].
fn each(of: impl Fn(&Bushing) -> bool, check: impl Fn(&str, &Bushing, &[Marker; 2])) {
    let mut checked = 0;
    for (name, joint) in joints() {
        if !of(&joint) {
            continue;
        }
        checked += 1;
        for (number, motion) in motions().iter().enumerate() {
            let name = format!("{name}, motion {number}");
            let load = joint.load(&motion[0], &motion[1]);
            assert!(load.force.norm() > 1e-3, "{name}: nothing acts");
            check(&name, &joint, motion);
        }
    }
    assert!(checked > 1);
}

/// Checks the joint's tangent against central differences with respect to all 24 components of motion.
#[test]
fn tangent_is_the_derivative_of_the_load() {
    let rows = |l: LinkLoad| [l.force, l.torque_i, l.torque_j];
    each(
        |_| true,
        |name, element, at| {
            let tangents = element.tangent(&at[0], &at[1], &element.load(&at[0], &at[1]));
            let h = 1e-6;
            for (body, tangent) in tangents.iter().enumerate() {
                let kinds = [tangent.p, tangent.v, tangent.a, tangent.w];
                for (kind, analytic) in kinds.iter().enumerate() {
                    for k in 0..3 {
                        let stepped = |h: f64| {
                            let mut m = *at;
                            m[body] = moved(&m[body], kind, k, h);
                            rows(element.load(&m[0], &m[1]))
                        };
                        let (plus, minus) = (stepped(h), stepped(-h));
                        for row in 0..3 {
                            let difference = (plus[row] - minus[row]) / (2.0 * h);
                            let error = (difference - analytic[row].column(k)).norm();
                            assert!(
                                error < 1e-7,
                                "{name}: body {body} kind {kind} column {k} row {row}: {error}"
                            );
                        }
                    }
                }
            }
        },
    );
}

/// Checks that a joint's forces on I and J have no total moment about the origin, `T_J = -T_I - d x F_I`;
/// `F_J = -F_I` holds by the definition of the load.
#[test]
fn moments_of_action_and_reaction_vanish() {
    each(
        |_| true,
        |name, element, [i, j]| {
            let load = element.load(i, j);
            let moment = load.torque_i + load.torque_j + (i.p - j.p).cross(&load.force);
            assert!(moment.norm() < 1e-13, "{name}: {moment}");
        },
    );
}

/// Checks the power balance of a joint, `dE/dt = -(power of the forces) - dissipation`, and that damping
/// dissipates.
#[test]
fn power_goes_into_energy_or_is_lost() {
    each(
        |joint| {
            let [torsion, bending] = joint.rotational_stiffness;
            torsion.to_bits() == bending.to_bits()
        },
        |name, element, [i, j]| {
            let load = element.load(i, j);
            let power =
                load.force.dot(&(i.v - j.v)) + load.torque_i.dot(&i.w) + load.torque_j.dot(&j.w);
            let advance = |m: &Marker, h: f64| Marker {
                p: m.p + m.v * h,
                rho: rotation(&(m.w * h)) * m.rho,
                R: rotation(&(m.w * h)) * m.R,
                ..*m
            };
            let energy = |h: f64| element.energy(&advance(i, h), &advance(j, h));
            let rate = (energy(1e-6) - energy(-1e-6)) / 2e-6;
            let defect = rate + power + load.dissipated;
            assert!(defect.abs() < 1e-7, "{name}: {rate} {power}");
            assert!(load.dissipated > 0.0, "{name}: {}", load.dissipated);
        },
    );
}

/// Checks that joint loads rotate with the frame and are independent of its origin, and that axial force,
/// dissipation and energy are invariant.
#[test]
fn nothing_depends_on_the_frame() {
    let turn = rotation(&V3::new(0.7, -1.3, 2.1));
    let shift = V3::new(3.0, -7.0, 11.0);
    let seen = |m: &Marker| Marker {
        p: turn * m.p + shift,
        rho: turn * m.rho,
        v: turn * m.v,
        w: turn * m.w,
        R: turn * m.R,
    };
    each(
        |_| true,
        |name, element, [i, j]| {
            let (here, there) = (element.load(i, j), element.load(&seen(i), &seen(j)));
            for (here, there) in [
                (here.force, there.force),
                (here.torque_i, there.torque_i),
                (here.torque_j, there.torque_j),
            ] {
                assert!((turn * here - there).norm() < 1e-13, "{name}");
            }
            assert!((here.axial - there.axial).abs() < 1e-13, "{name}");
            assert!((here.dissipated - there.dissipated).abs() < 1e-13, "{name}");
            let energies = element.energy(i, j) - element.energy(&seen(i), &seen(j));
            assert!(energies.abs() < 1e-13, "{name}");
        },
    );
}

/// Checks the joint's tangent including an additional axial tension `7 x^2 + 2 x' x` of extension `x` against
/// finite differences.
#[test]
fn a_further_pull_has_its_tangent() {
    let element = BUSHING;
    let loaded = |m: &[Marker; 2]| {
        let [x, rate] = element.extension(&m[0], &m[1]);
        let pull = AxialTension {
            force: 7.0 * x * x + 2.0 * rate * x,
            dissipated: 0.0,
            by_extension: 14.0 * x + 2.0 * rate,
            by_rate: 2.0 * x,
        };
        let mut load = element.load(&m[0], &m[1]);
        element.add_pull((&m[0], &m[1]), &pull, &mut load);
        (load, pull)
    };
    let h = 1e-6;
    for at in motions() {
        let (load, further) = loaded(&at);
        let tangents = element.tangent_with(&at[0], &at[1], &load, Some(&further));
        for (body, tangent) in tangents.iter().enumerate() {
            let kinds = [tangent.p, tangent.v, tangent.a, tangent.w];
            for (kind, analytic) in kinds.iter().enumerate() {
                for k in 0..3 {
                    let step = |h: f64| {
                        let mut m = at;
                        m[body] = moved(&m[body], kind, k, h);
                        let (l, _) = loaded(&m);
                        [l.force, l.torque_i, l.torque_j]
                    };
                    let (plus, minus) = (step(h), step(-h));
                    for row in 0..3 {
                        let difference = (plus[row] - minus[row]) / (2.0 * h);
                        let error = (difference - analytic[row].column(k)).norm();
                        assert!(error < 1e-6, "{body} {kind} {k} {row}: {error}");
                    }
                }
            }
        }
    }
}
