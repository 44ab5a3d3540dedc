//! Contract tests of all force laws, of the joint in the plane, and of the bushing in space: tangent, action and
//! reaction, power balance, independence of the frame, equal bits in SIMD lanes.
use super::bushing::{AxialTension, Bushing, LinkLoad, Marker};
use super::impact::Impact;
use super::law::{ForceLaw, LawResponse};
use super::plane::{PlaneJoint, PlaneRod, Side};
use crate::math::real::{Vector, WIDEST};
use nalgebra::{Matrix3, Rotation3, Vector3};
use pulp::{Arch, Scalar, Simd, WithSimd};

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

const IMPACT: Impact = Impact {
    stiffness: 3.0e6,
    exponent: 1.7,
    damping: 40.0,
    full_damping_penetration: 1e-3,
};

/// Checks every law of the workspace; a new law is one line here.
#[test]
fn laws_keep_their_contract() {
    let joint = [[0.3, -0.2, 0.7], [-0.4, 0.1, -1.3], [0.0, 0.6, 0.2]];
    law(
        "bushing",
        BUSHING,
        &joint,
        &joint.map(|x| x.map(|x| 1.1 - x)),
    );
    let depths = [[4e-4], [9.9e-4], [3e-3], [-2e-4]];
    law("impact", IMPACT, &depths, &[[0.3], [-0.2], [0.7], [0.5]]);
    let root = Impact {
        exponent: 1.5,
        ..IMPACT
    };
    law(
        "impact, root",
        root,
        &depths,
        &[[-0.3], [0.2], [-0.7], [5.0]],
    );
}

/// Asserts that a derivative agrees with a difference to six digits of the larger one, or of `scale`.
#[track_caller]
fn assert_near(name: &str, derivative: f64, difference: f64, scale: f64) {
    let error = (derivative - difference).abs();
    let size = scale.max(difference.abs());
    assert!(error <= 2e-6 * size, "{name}: {derivative} {difference}");
}

/// Checks one law at the given deformations and their rates.
fn law<L: ForceLaw<N, C>, const N: usize, const C: usize>(
    name: &str,
    law: L,
    deformations: &[[f64; N]],
    rates: &[[f64; N]],
) {
    for (x, v) in deformations.iter().zip(rates) {
        let at = law.response(*x, *v);
        let scale = at
            .stiffness
            .as_flattened()
            .iter()
            .fold(1e-9, |s: f64, k| s.max(k.abs()));
        let moved = |y: &[f64; N], k: usize, h: f64| {
            let mut y = *y;
            y[k] += h;
            y
        };
        for k in 0..N {
            let h = 1e-6 * x[k].abs().max(1e-4);
            let [plus, minus] = [h, -h].map(|h| law.response(moved(x, k, h), *v));
            let steady = [h, -h].map(|h| law.response(moved(x, k, h), [0.0; N]));
            let elastic = law.response(*x, [0.0; N]).force[k];
            let by_energy = (steady[0].energy - steady[1].energy) / (2.0 * h);
            assert_near(name, elastic, by_energy, scale * h);
            for r in 0..N {
                let by_place = (plus.force[r] - minus.force[r]) / (2.0 * h);
                assert_near(name, at.stiffness[r][k], by_place, scale);
                let h = 1e-6;
                let [plus, minus] = [h, -h].map(|h| law.response(*x, moved(v, k, h)));
                let by_rate = (plus.force[r] - minus.force[r]) / (2.0 * h);
                assert_near(name, at.damping[r][k], by_rate, 1.0);
            }
        }
        // the power of the forces is stored or lost
        let power: f64 = at.force.iter().zip(v).map(|(f, v)| f * v).sum();
        let elastic = law.response(*x, [0.0; N]).force;
        let stored: f64 = elastic.iter().zip(v).map(|(f, v)| f * v).sum();
        assert_near(name, at.dissipated, power - stored, power.abs());
        assert!(at.dissipated >= 0.0, "{name}: {}", at.dissipated);
        let coefficients = law.coefficients();
        let by = law.by_coefficients(*x, *v);
        for c in 0..C {
            let changed = |by: f64| {
                let mut all = coefficients;
                all[c] *= 1.0 + by;
                law.with_coefficients(all).response(*x, *v).force
            };
            let (plus, minus) = (changed(1e-6), changed(-1e-6));
            for r in 0..N {
                let difference = (plus[r] - minus[r]) / (2e-6 * coefficients[c]);
                assert_near(name, by[c][r], difference, by[c][r].abs().max(1e-9));
            }
        }
        let single = flat(&at, &by, f64::to_bits);
        let lanes = Arch::new().dispatch(InLanes(law, *x, *v));
        assert!(
            lanes.iter().all(|lane| *lane == single),
            "{name}: other bits in lanes"
        );
        let narrow = InLanes(law, *x, *v).with_simd(Scalar);
        assert!(
            narrow.iter().all(|lane| *lane == single),
            "{name}: other bits in lanes"
        );
    }
}

/// Lists all numbers of a law's answer.
fn flat<T: Copy, B, const N: usize, const C: usize>(
    at: &LawResponse<T, N>,
    by: &[[T; N]; C],
    bits: impl Fn(T) -> B,
) -> Vec<B> {
    let matrices = [&at.stiffness, &at.damping].into_iter().flatten();
    let rows = matrices.chain([&at.force]).chain(by).flatten();
    rows.chain([&at.energy, &at.dissipated])
        .map(|x| bits(*x))
        .collect()
}

/// Law with a deformation and a rate, the same in every lane.
struct InLanes<L, const N: usize, const C: usize>(L, [f64; N], [f64; N]);

impl<L: ForceLaw<N, C>, const N: usize, const C: usize> WithSimd for InLanes<L, N, C> {
    /// Bits of all numbers of the answer, lane by lane.
    type Output = Vec<Vec<u64>>;

    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self(law, x, v) = self;
        let splat = |x: f64| Vector::splat(simd, x);
        let (x, v) = (x.map(splat), v.map(splat));
        let all = flat(&law.response(x, v), &law.by_coefficients(x, v), |x| {
            let mut lanes = [0.0; WIDEST];
            S::as_mut_simd_f64s(&mut lanes).0[0] = x.lanes();
            lanes.map(f64::to_bits)
        });
        (0..S::F64_LANES)
            .map(|lane| all.iter().map(|x| x[lane]).collect())
            .collect()
    }
}

/// Two rods in general motion, far beyond a small turn.
const RODS: [[f64; 6]; 2] = [
    [0.45, 0.1, 0.9, 0.3, -0.8, 0.6],
    [0.1, -0.3, -0.4, -0.5, 0.2, 1.1],
];

fn rod([x, y, angle, vx, vy, rate]: [f64; 6]) -> PlaneRod<f64> {
    let (s, c) = crate::math::elementary::sin_cos(angle);
    PlaneRod {
        place: [x, y],
        velocity: [vx, vy],
        axis: [c, s],
        angle,
        rate,
    }
}

/// Checks that a joint between two rods in the plane is the bushing in space between markers at their ends.
#[test]
fn joint_in_the_plane_is_the_bushing_in_space() {
    let half = 0.2;
    let [i, j] = RODS.map(rod);
    let marker = |rod: &PlaneRod<f64>, along: f64| {
        let [[x, y], [vx, vy], [c, s]] = [rod.place, rod.velocity, rod.axis];
        Marker {
            p: V3::new(x, y, 0.0),
            rho: V3::new(c, s, 0.0) * along,
            v: V3::new(vx, vy, 0.0),
            w: V3::new(0.0, 0.0, rod.rate),
            R: crate::math::rotation::about_z(s, c),
        }
    };
    let (i_marker, j_marker) = (marker(&i, -half), marker(&j, half));
    let expected = BUSHING.load(&i_marker, &j_marker);
    let joint = PlaneJoint::new(half, &i, &j);
    let answer = BUSHING.response(joint.deformation, joint.rate);
    let load = joint.load(answer.force);
    let pairs = [
        (load.force[0], expected.force.x),
        (load.force[1], expected.force.y),
        (load.torque[0], expected.torque_i.z),
        (load.torque[1], expected.torque_j.z),
        (-answer.force[0], expected.axial),
        (answer.dissipated, expected.dissipated),
        (answer.energy, BUSHING.energy(&i_marker, &j_marker)),
    ];
    for (k, (here, there)) in pairs.into_iter().enumerate() {
        assert!((here - there).abs() < 1e-14, "{k}: {here} {there}");
    }
    let [extension, rate] = BUSHING.extension(&i_marker, &j_marker);
    assert!((joint.deformation[0] - extension).abs() < 1e-15);
    assert!((joint.rate[0] - rate).abs() < 1e-15);
}

/// Checks stiffness and damping of a joint in the plane against differences of its forces, and that a whole
/// turn of a rod changes nothing.
#[test]
fn tangent_of_a_joint_in_the_plane_is_the_derivative_of_its_load() {
    let forces = |rods: [[f64; 6]; 2]| {
        let [i, j] = rods.map(rod);
        let joint = PlaneJoint::new(0.2, &i, &j);
        let load = joint.load(BUSHING.response(joint.deformation, joint.rate).force);
        let ([x, y], [torque_i, torque_j]) = (load.force, load.torque);
        [[x, y, torque_i], [-x, -y, torque_j]]
    };
    let [i, j] = RODS.map(rod);
    let joint = PlaneJoint::new(0.2, &i, &j);
    let tangents = joint.tangents(&BUSHING.response(joint.deformation, joint.rate));
    let sides = [Side::I, Side::J];
    let h = 1e-6;
    for (kind, tangent) in tangents.iter().enumerate() {
        for (b, by) in sides.into_iter().enumerate() {
            for column in 0..3 {
                let stepped = |h: f64| {
                    let mut rods = RODS;
                    rods[b][3 * kind + column] += h;
                    forces(rods)
                };
                let (plus, minus) = (stepped(h), stepped(-h));
                for (o, of) in sides.into_iter().enumerate() {
                    for row in 0..3 {
                        let difference = (minus[o][row] - plus[o][row]) / (2.0 * h);
                        let entry = tangent.entry((of, row), (by, column));
                        let error = (entry - difference).abs();
                        assert!(error < 1e-8, "{kind} {of:?} {row} {by:?} {column}: {error}");
                    }
                }
            }
        }
    }
    let mut turned = RODS;
    turned[0][2] += std::f64::consts::TAU;
    for (here, there) in forces(RODS)
        .as_flattened()
        .iter()
        .zip(forces(turned).as_flattened())
    {
        assert!((here - there).abs() < 1e-13, "{here} {there}");
    }
}
