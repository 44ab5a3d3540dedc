//! What an effect says of itself: its name, where it acts, and its free numbers with their units,
//! bounds and sizes.
//!
//! All numbers are in the declared unit; [`Unit::to_si`] gives what the equations take.
use super::{Effect, probe};
use std::borrow::Cow;

/// One effect of the catalogue.
#[derive(Clone, Debug)]
pub struct Descriptor {
    /// Fixed identifier.
    pub id: Cow<'static, str>,
    /// In words.
    pub title: Cow<'static, str>,
    /// Joint or part of the machine that it acts at.
    pub joint: &'static str,
    /// What of the model it changes.
    pub place: Place,
    /// Whether it is a form of force without a cause, for localisation alone.
    pub generic: bool,
    /// Its free numbers.
    pub parameters: Cow<'static, [Parameter]>,
    pub(super) build: Build,
}

/// How an effect is made of its values: SI, one per parameter, in the order of the descriptor.
#[derive(Clone, Copy, Debug)]
pub(super) enum Build {
    /// A named effect.
    Named(fn(&[f64]) -> Box<dyn Effect>),
    /// A generic force.
    Probe(&'static probe::Joint, probe::Form),
}

/// What of the model an effect changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Geometry, inertia or forces of the machine.
    Dynamics,
    /// The motion of the crank, or where its angle is zero.
    Drive,
    /// The load at the suspension point.
    Load,
    /// The chain from strain to reading.
    Gauge,
}

/// One free number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name within the effect.
    pub name: &'static str,
    /// Unit of all its values.
    pub unit: Unit,
    /// What it does for its effect.
    pub role: Role,
    /// Value at which the effect is not there; of a shape, its typical value.
    pub absent: f64,
    /// Value with which a signature is taken, and the default of a shape.
    pub typical: f64,
    /// Its physical size.
    pub scale: f64,
    /// Least value.
    pub lower: f64,
    /// Greatest value.
    pub upper: f64,
}

/// What a parameter does for its effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// At its absent value it contributes nothing.
    Size,
    /// It forms what the sizes switch on.
    Shape,
}

impl Parameter {
    /// A size: absent at 0. Bounds that exclude what is negative make it one-sided.
    pub(super) const fn size(
        name: &'static str,
        unit: Unit,
        typical: f64,
        [lower, upper]: [f64; 2],
    ) -> Self {
        Self {
            name,
            unit,
            role: Role::Size,
            absent: 0.0,
            typical,
            scale: typical.abs(),
            lower,
            upper,
        }
    }

    /// A shape, with its typical value.
    pub(super) const fn shape(
        name: &'static str,
        unit: Unit,
        typical: f64,
        [lower, upper]: [f64; 2],
    ) -> Self {
        Self {
            name,
            unit,
            role: Role::Shape,
            absent: typical,
            typical,
            scale: 0.5 * (upper - lower),
            lower,
            upper,
        }
    }

    /// Whether it can only be at or above its absent value.
    pub fn is_one_sided(&self) -> bool {
        self.role == Role::Size && self.lower >= self.absent
    }
}

/// Units of parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// A share, a ratio, a number of harmonics.
    One,
    /// Length.
    Metre,
    /// Time.
    Second,
    /// Angle.
    Degree,
    /// Force.
    Newton,
    /// Moment.
    NewtonMetre,
    /// Damping of a motion along a line.
    NewtonSecondPerMetre,
    /// Damping of a turning motion.
    NewtonMetreSecondPerRadian,
    /// Compliance.
    MetrePerNewton,
    /// Speed.
    MetrePerSecond,
    /// Angular speed.
    RadianPerSecond,
    /// Frequency.
    Hertz,
    /// Decay.
    PerSecond,
    /// Mass.
    Kilogram,
    /// Moment of inertia.
    KilogramSquareMetre,
    /// Stress.
    Megapascal,
    /// Stress per revolution of the crank.
    MegapascalPerRevolution,
    /// Stress per length.
    MegapascalPerMetre,
    /// Force on a mass-normalised modal coordinate.
    ModalNewton,
}

impl Unit {
    /// As written in tables and files.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::One => "1",
            Self::Metre => "m",
            Self::Second => "s",
            Self::Degree => "deg",
            Self::Newton => "N",
            Self::NewtonMetre => "N.m",
            Self::NewtonSecondPerMetre => "N.s/m",
            Self::NewtonMetreSecondPerRadian => "N.m.s/rad",
            Self::MetrePerNewton => "m/N",
            Self::MetrePerSecond => "m/s",
            Self::RadianPerSecond => "rad/s",
            Self::Hertz => "Hz",
            Self::PerSecond => "1/s",
            Self::Kilogram => "kg",
            Self::KilogramSquareMetre => "kg.m2",
            Self::Megapascal => "MPa",
            Self::MegapascalPerRevolution => "MPa/rev",
            Self::MegapascalPerMetre => "MPa/m",
            Self::ModalNewton => "N/kg^0.5",
        }
    }

    /// A value in SI, angles in radians, stress in pascals; hertz and revolutions stay.
    pub const fn to_si(self, value: f64) -> f64 {
        match self {
            Self::Degree => value.to_radians(),
            Self::Megapascal | Self::MegapascalPerRevolution | Self::MegapascalPerMetre => {
                value * 1e6
            }
            Self::One
            | Self::Metre
            | Self::Second
            | Self::Newton
            | Self::NewtonMetre
            | Self::NewtonSecondPerMetre
            | Self::NewtonMetreSecondPerRadian
            | Self::MetrePerNewton
            | Self::MetrePerSecond
            | Self::RadianPerSecond
            | Self::Hertz
            | Self::PerSecond
            | Self::Kilogram
            | Self::KilogramSquareMetre
            | Self::ModalNewton => value,
        }
    }
}

impl Descriptor {
    /// Position of a parameter by its name.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|p| p.name == name)
    }
}
