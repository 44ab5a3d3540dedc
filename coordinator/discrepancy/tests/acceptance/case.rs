//! What both sides know: the data sheet of the stand-in machine. Its cards, its genes, its grid; no
//! equation of motion.
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Place, Role, Sign};
use protocol::case::{Coefficient, Gene};
use protocol::unit::Unit;
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

/// A gene with bounds of two decades either way.
fn gene(name: Coefficient, unit: Unit, recommended: f64) -> Gene {
    let bounds = [0.01 * recommended, 100.0 * recommended];
    Gene::coefficient(name, unit, recommended, bounds)
}

/// Recommended genes, in the order of [`Coefficient::ALL`].
pub(crate) const RECOMMENDED: [f64; 10] =
    [3150.0, 345.0, 10.0, 1.0, 20.0, 2.0, 1.0, 1.0, 1500.0, 10.0];

/// The space of the genes.
pub(crate) fn space() -> Space {
    let stiffness = Unit::NewtonPerMetre;
    let damping = Unit::NewtonSecondPerMetre;
    let genes: Vec<Gene> = Coefficient::ALL
        .iter()
        .zip(RECOMMENDED)
        .enumerate()
        .map(|(k, (&name, value))| {
            gene(
                name,
                if k < 4 || k == 8 { stiffness } else { damping },
                value,
            )
        })
        .collect();
    Space::new(&genes).expect("positive and ordered")
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
