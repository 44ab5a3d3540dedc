//! What both sides know: the data sheet of the stand-in machine. Its cards, its unknowns, its grid; no
//! equation of motion.
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Place, Role, Sign};
use protocol::case::{Scale, Shares, Shift, Unknown, Valley};
use search::space::Space;
use std::f64::consts::TAU;

/// Samples of a turn.
pub(crate) const SAMPLES: usize = 144;
/// Highest order that is compared.
pub(crate) const ORDERS: usize = 40;
/// Speeds of the conditions, as shares of the first.
pub(crate) const SPEED: [f64; 2] = [1.0, 0.8];

/// The load card of a condition (kN) at a crank angle (rad): 14 harmonics of a pump's load, and the
/// ripple of a rod string that each reversal sets swinging.
pub(crate) fn card(condition: usize, angle: f64) -> f64 {
    const HARMONICS: [(f64, f64); 14] = [
        (17.0, -1.2),
        (3.1, 0.4),
        (4.6, -2.1),
        (1.9, 0.9),
        (2.3, -0.3),
        (1.2, 2.0),
        (1.3, -1.4),
        (0.9, 0.1),
        (0.8, 2.7),
        (0.7, -0.8),
        (0.6, 1.1),
        (0.45, -2.5),
        (0.4, 0.6),
        (0.3, 1.9),
    ];
    let turn = 0.25 * condition as f64;
    let swing = 1.0 - 0.15 * condition as f64;
    let slow: f64 = HARMONICS
        .iter()
        .zip(1_u32..)
        .map(|((amplitude, phase), order)| {
            amplitude * (f64::from(order) * angle + phase + turn).cos()
        })
        .sum();
    let ripple: f64 = [(0.5, 16), (0.7, 19), (0.3, 22), (0.2, 27), (0.2, 32)]
        .iter()
        .map(|&(amplitude, order)| amplitude * (f64::from(order) * (angle - 0.4)).cos())
        .sum();
    62.0 + swing * slow + ripple
}

/// An unknown with bounds of two decades either way.
pub(crate) fn unknown(name: &str, start: f64, trust: [f64; 2]) -> Unknown {
    let bounds = [0.01 * start, 100.0 * start];
    Unknown {
        trust: Some(trust),
        ..Unknown::new(name, "1", Scale::Logarithmic, start, bounds)
    }
}

/// How far stiffness and loss are trusted about their recommended values (decades).
pub(crate) const STIFFNESS: [f64; 2] = [-1.0, 1.5];
pub(crate) const LOSS: [f64; 2] = [-1.0, 4.0];

/// The valley of a stiffness that rings, with the loss over it and what can stand in for it.
pub(crate) fn valley(loss: &str, contact: &str) -> Valley {
    let shift = |unknown: &str, by| Shift {
        unknown: unknown.to_owned(),
        by,
    };
    Valley {
        from: -0.3,
        to: 1.1,
        step: 0.02,
        uncovered_by: vec![shift(loss, -0.8), shift(contact, 1.5)],
        shares: Some(Shares {
            unknown: loss.to_owned(),
            of_scanned: vec![6e-4, 2e-3],
        }),
        stand_ins: vec![shift(contact, 1.5), shift(contact, -1.5)],
    }
}

/// Recommended values: stiffness of the rope along, across, in torsion and in bending, losses of the
/// same, stiffness and loss of the contact.
pub(crate) const RECOMMENDED: [f64; 10] =
    [3150.0, 345.0, 10.0, 1.0, 20.0, 2.0, 1.0, 1.0, 1500.0, 10.0];

/// The space of the unknowns.
pub(crate) fn space() -> Space {
    let unknowns = RECOMMENDED.iter().enumerate().map(|(k, &value)| {
        let trust = if k < 4 || k == 8 { STIFFNESS } else { LOSS };
        unknown(&format!("x{k}"), value, trust)
    });
    let mut unknowns: Vec<Unknown> = unknowns.collect();
    unknowns[0].valley = Some(valley("x4", "x8"));
    Space::new(&unknowns).expect("positive and ordered")
}

/// Crank angles of the grid (rad).
pub(crate) fn grid() -> impl Iterator<Item = f64> {
    (0..SAMPLES).map(|i| TAU * i as f64 / SAMPLES as f64)
}

/// A size that may be forty times its usual value.
pub(crate) fn size(name: &str, unit: &str, typical: f64, sign: Sign) -> ParameterDescriptor {
    ParameterDescriptor {
        name: name.to_owned(),
        unit: unit.to_owned(),
        role: Role::Size,
        sign,
        lower: -40.0 * typical,
        upper: 40.0 * typical,
        absent: 0.0,
        typical,
        scale: typical,
    }
}

/// An effect as a worker announces it.
pub(crate) fn effect(
    id: &str,
    joint: &str,
    place: Place,
    parameters: Vec<ParameterDescriptor>,
) -> EffectDescriptor {
    EffectDescriptor {
        id: id.to_owned(),
        title: id.replace('_', " "),
        joint: joint.to_owned(),
        place,
        generic: false,
        parameters,
    }
}
