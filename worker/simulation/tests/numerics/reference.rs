//! Comparison of ropes with results of other programs (tests/reference): Exudyn and a scipy model.
use crate::rope::*;
use simulation::model::description::RopeLaw;
use simulation::rig::{Drum, End, Rig, Setup};
use simulation::system::System;

/// Checks a cantilever of 40 bushings under a dead load at its end.
///
/// Small loads are compared with formulas: tip deflection `F sum_k (k L)^2 / K_66 + F N / K_22`, twist `T N /
/// K_44`, extension `F N / K_11`, rotation `M N / K_66`. Large loads are compared with Exudyn.
#[test]
fn cantilever_bends_twists_and_stretches_as_in_exudyn() {
    let rows = include_str!("../reference/a_cantilever_tip.csv")
        .lines()
        .skip(1);
    let mut compared = 0;
    for row in rows {
        // the load is a list in quotes
        let (head, rest) = row.split_once('"').unwrap();
        let (load, tail) = rest.split_once('"').unwrap();
        let load: Vec<f64> = load
            .trim_matches(['[', ']'])
            .split(',')
            .map(|x| x.trim().parse().unwrap())
            .collect();
        let load = V3::new(load[0], load[1], load[2]);
        let (law, case) = head.trim_end_matches(',').split_once(',').unwrap();
        let law = if law == "rec" {
            recommended()
        } else {
            optimised()
        };
        let fields: Vec<&str> = tail.trim_start_matches(',').split(',').collect();
        let expected: f64 = fields[1].parse().unwrap();

        let mut setup = cantilever(40, law.bushing);
        let turning = fields[0] == "tip_rotation_rad";
        let force = if turning { V3::zeros() } else { load };
        let [twist, turn] = if turning { [load.x, load.z] } else { [0.0; 2] };
        setup.ends[1] = End::Free { force, twist, turn };
        let (system, q) = settled_straight(&setup);
        let tip = system.equations.outer_end(39);
        let last = &q[39 * 6..];
        let found = match case {
            "bend_xy" | "bend_xy_large" => tip.y,
            "bend_xz" | "bend_xz_large" => tip.z,
            "axial" => tip.x - 2.0,
            "torsion" => last[3],
            "moment_xy" => last[5],
            other => panic!("{other}"),
        };
        let error = (found / expected - 1.0).abs();
        eprintln!("{head} {error:.1e}");
        // Exudyn's own bushings leave out the couple of the displacement: 1e-5 where ropes bend
        assert!(error < 5e-5, "{head}: {found} for {expected}");
        if let Ok(linear) = fields[3].parse::<f64>()
            && linear.is_finite()
        {
            let error = (found / linear - 1.0).abs();
            assert!(error < 5e-5, "{head}: {found} for the closed form {linear}");
        }
        compared += 1;
    }
    assert_eq!(compared, 14);
}

/// Checks the whole shape of a cantilever bent by 0.63 m and 0.31 m at its end against Exudyn.
#[test]
fn strongly_bent_cantilever_has_exudyns_shape() {
    for (law, text) in [
        (
            recommended(),
            include_str!("../reference/a_cantilever_rec_bend_xy_large_shape.csv"),
        ),
        (
            optimised(),
            include_str!("../reference/a_cantilever_opt_bend_xy_large_shape.csv"),
        ),
    ] {
        let mut setup = cantilever(40, law.bushing);
        setup.ends[1] = End::Free {
            force: V3::new(0.0, -100.0, 0.0),
            twist: 0.0,
            turn: 0.0,
        };
        let (system, _) = settled_straight(&setup);
        let shape = table(text);
        let bend = shape[39][2].abs();
        for (j, row) in shape.iter().enumerate() {
            let error = (system.equations.outer_end(j) - V3::new(row[1], row[2], row[3])).norm();
            assert!(error < 5e-5 * bend, "cylinder {j}: {error}");
        }
    }
}

/// Checks a horizontal chain of 60 cylinders that falls when gravity is switched on (large motion).
///
/// Two programs give the tip's path; the simulation must follow both within 0.05 % of the tip's travel.
#[test]
fn falling_chain_follows_the_reference() {
    // with the columns of Exudyn's path
    let cases: [(&str, RopeLaw, &str, [usize; 2]); 3] = [
        (
            "rec",
            recommended(),
            include_str!("../reference/b_hanging_rec.csv"),
            [6, 7],
        ),
        (
            "opt",
            optimised(),
            include_str!("../reference/b_hanging_opt.csv"),
            [6, 7],
        ),
        (
            "soft",
            soft(),
            include_str!("../reference/b_hanging_soft.csv"),
            [4, 5],
        ),
    ];
    for (name, law, text, exudyn) in cases {
        let mut setup = cantilever(60, law.bushing);
        setup.gravity = V3::new(0.0, -9.81, 0.0);
        let mut system = System::new(Rig::new(setup));
        let q = system.equations.straight(V3::zeros(), 0.0);
        let v = vec![0.0; q.len()];
        let mut state = started(&mut system, q, v);
        let course = Course {
            longest: 2e-3,
            ..Course::accurate(0.01)
        };
        let rows = table(text);
        let travel = rows
            .iter()
            .map(|row| (row[1] - 3.0).hypot(row[2]))
            .fold(0.0, f64::max);
        let mut worst = [0.0_f64; 2];
        for row in &rows {
            advance(&mut system, &course, &mut state, row[0], |_, _, _| {});
            let last = &state.q[59 * 6..];
            let (s, c) = last[5].sin_cos();
            let tip = [last[0] + 0.025 * c, last[1] + 0.025 * s];
            for (worst, [x, y]) in worst.iter_mut().zip([[1, 2], exudyn]) {
                *worst = worst.max((tip[0] - row[x]).hypot(tip[1] - row[y]));
            }
        }
        eprintln!("falling chain {name}: {worst:?} of {travel:.3} m");
        assert!(
            worst.iter().all(|&e| e < 5e-4 * travel),
            "{name}: {worst:?}"
        );
    }
}

fn drum_setup(law: &RopeLaw, pull: f64) -> Setup {
    Setup {
        chain: simulation::model::chain::Chain {
            contact_points: &[(0.0, 1.0), (0.0, 0.0), (0.0, 0.0)],
            ..chain(60)
        },
        gravity: V3::zeros(),
        joint: law.bushing,
        ends: [
            End::Held {
                place: V3::new(0.0, 1.205, 0.0),
                angle: 0.0,
                law: law.bushing,
            },
            End::Free {
                force: V3::new(0.0, -pull, 0.0),
                twist: 0.0,
                turn: 0.0,
            },
        ],
        drum: Some(Drum {
            center: [0.0; 2],
            radius: 1.205,
            law: law.contact,
        }),
    }
}

/// Returns coordinates of cylinders that lie on the rig's drum, clockwise from its top over the angle `wrap`,
/// and then continue straight.
pub(crate) fn laid_on_drum(count: usize, wrap: f64) -> Vec<f64> {
    let (pitch, radius) = (0.05_f64, 1.205_f64);
    let turn = 2.0 * (0.5 * pitch / radius).asin();
    let (mut at, mut q) = ([0.0, radius], Vec::new());
    for j in 0..count {
        let angle = -turn * (j as f64 + 0.5);
        let angle = angle.max(-wrap);
        let (s, c) = angle.sin_cos();
        q.extend([
            at[0] + 0.5 * pitch * c,
            at[1] + 0.5 * pitch * s,
            0.0,
            0.0,
            0.0,
            angle,
        ]);
        at = [at[0] + pitch * c, at[1] + pitch * s];
    }
    q
}

/// Returns tension, shear and moment of joint `j` of a rig, acting on the body before it, and the contact
/// force of cylinder `j`.
fn carried(system: &System<Rig>, law: &RopeLaw, q: &[f64], j: usize) -> [f64; 4] {
    let state = &system.equations.state;
    // on J acts the opposite of the load on I; J is the ground or the cylinder before
    let load = &state.joints[j];
    let angle = if j == 0 { 0.0 } else { q[6 * (j - 1) + 5] };
    let (s, c) = angle.sin_cos();
    let shear = -(load.force.y * c - load.force.x * s);
    // T_J about the joint: bending stiffness times the turn, and the couple of d x F
    let [_, bending] = law.bushing.rotational_stiffness;
    let moment = bending * (q[6 * j + 5] - angle);
    [state.tension(j), shear, moment, state.contact[j]]
}

/// Checks a rope over a fixed drum, with one contact point per cylinder as in both references: positions of
/// the cylinders, joint loads and contact forces.
#[test]
fn rope_on_a_drum_has_the_references_forces() {
    let cases: [(&str, RopeLaw, f64, [&str; 2]); 4] = [
        (
            "rec",
            recommended(),
            1e4,
            [
                include_str!("../reference/c_drum_rec_10kN.csv"),
                include_str!("../reference/c_drum_rec_10kN_exudyn.csv"),
            ],
        ),
        (
            "rec",
            recommended(),
            5e4,
            [
                include_str!("../reference/c_drum_rec_50kN.csv"),
                include_str!("../reference/c_drum_rec_50kN_exudyn.csv"),
            ],
        ),
        (
            "opt",
            optimised(),
            1e4,
            [
                include_str!("../reference/c_drum_opt_10kN.csv"),
                include_str!("../reference/c_drum_opt_10kN_exudyn.csv"),
            ],
        ),
        (
            "opt",
            optimised(),
            5e4,
            [
                include_str!("../reference/c_drum_opt_50kN.csv"),
                include_str!("../reference/c_drum_opt_50kN_exudyn.csv"),
            ],
        ),
    ];
    for (name, law, pull, [text, exudyn]) in cases {
        let (system, q) = settled(
            &drum_setup(&law, pull),
            laid_on_drum(60, 0.5 * std::f64::consts::PI),
        );
        let largest = |column: usize| {
            table(text)
                .iter()
                .map(|row| row[column].abs())
                .fold(0.0, f64::max)
        };
        let scales = [4, 5, 6, 7].map(largest);
        let mut worst = [0.0_f64; 5];
        let mut from_exudyn = [0.0_f64; 4];
        for (j, (row, other)) in table(text).iter().zip(table(exudyn)).enumerate() {
            let own = &q[6 * j..];
            let distance = (own[0] - row[1])
                .hypot(own[1] - row[2])
                .max(0.05 * (own[5] - row[3]).abs());
            worst[0] = worst[0].max(distance);
            let found = carried(&system, &law, &q, j);
            for k in 0..4 {
                worst[1 + k] = worst[1 + k].max((found[k] - row[4 + k]).abs() / scales[k]);
            }
            let distance = (own[0] - other[1]).hypot(own[1] - other[2]);
            from_exudyn[0] = from_exudyn[0].max(distance);
            // it has no moments
            for (at, k) in [(3, 0), (4, 1), (5, 3)] {
                let error = (found[k] - other[at]).abs() / scales[k];
                from_exudyn[at - 2] = from_exudyn[at - 2].max(error);
            }
        }
        eprintln!("drum {name} {pull}: {worst:?}, from Exudyn {from_exudyn:?}");
        assert!(
            from_exudyn[0] < 1e-4 && from_exudyn[1..].iter().all(|&e| e < 5e-3),
            "{name} {pull}: {from_exudyn:?}"
        );
        assert!(worst[0] < 1e-6, "{name} {pull}: placed {} m off", worst[0]);
        assert!(
            worst[1..].iter().all(|&e| e < 5e-3),
            "{name} {pull}: {worst:?}"
        );
    }
}
