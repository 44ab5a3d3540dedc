//! Data sheet of the stand-in machine (a cheap model for tests), shared by its simulation and the diagnosis:
//! load cards, unknowns and grid, without the equation of motion.
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Place, Role, Sign};
use protocol::case::{HeldRatios, Scale, Shift, Unknown, Valley};
use search::space::Space;
use std::f64::consts::TAU;

/// Number of samples per turn of the crank.
pub(crate) const SAMPLES: usize = 144;
/// Highest order of the crank's turn that is compared.
pub(crate) const ORDERS: usize = 40;
/// Crank speeds of the two conditions, relative to that of the first.
pub(crate) const SPEED: [f64; 2] = [1.0, 0.8];

/// Returns the load card of a condition (kN) at a crank angle (rad): 14 harmonics of a pump's load, and the
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

/// Creates an unknown with bounds two decades below and above its start.
pub(crate) fn unknown(name: &str, start: f64, trust: [f64; 2]) -> Unknown {
    let bounds = [0.01 * start, 100.0 * start];
    Unknown {
        trust: Some(trust),
        ..Unknown::new(name, "1", Scale::Logarithmic, start, bounds)
    }
}

/// Trusted range of a stiffness about its recommended value (decades); `LOSS` is that of a loss.
pub(crate) const STIFFNESS: [f64; 2] = [-1.0, 1.5];
pub(crate) const LOSS: [f64; 2] = [-1.0, 4.0];

/// Describes the narrow minimum (valley) of a resonant stiffness for the valley search, with the shifts of
/// the unknowns `loss` and `contact` that uncover it and the shifts of `contact` that can stand in for it.
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
        shares: Some(HeldRatios {
            unknown: loss.to_owned(),
            of_scanned: vec![6e-4, 2e-3],
        }),
        stand_ins: vec![shift(contact, 1.5), shift(contact, -1.5)],
    }
}

/// Recommended values: stiffness of the rope in tension, shear, torsion and bending, the losses in the same
/// order, stiffness and loss of the contact.
pub(crate) const RECOMMENDED: [f64; 10] =
    [3150.0, 345.0, 10.0, 1.0, 20.0, 2.0, 1.0, 1.0, 1500.0, 10.0];

/// Returns the search space of the unknowns.
pub(crate) fn space() -> Space {
    let unknowns = RECOMMENDED.iter().enumerate().map(|(k, &value)| {
        let trust = if k < 4 || k == 8 { STIFFNESS } else { LOSS };
        unknown(&format!("x{k}"), value, trust)
    });
    let mut unknowns: Vec<Unknown> = unknowns.collect();
    unknowns[0].valley = Some(valley("x4", "x8"));
    Space::new(&unknowns).expect("positive and ordered")
}

/// Iterates over the crank angles of the grid (rad).
pub(crate) fn grid() -> impl Iterator<Item = f64> {
    (0..SAMPLES).map(|i| TAU * i as f64 / SAMPLES as f64)
}

/// Creates a size parameter of an effect, with bounds at forty times its typical value.
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

/// Creates a test effect's descriptor, as a worker announces it.
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
