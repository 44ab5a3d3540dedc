//! Units of effect parameters, with their symbols and their conversion to SI.

/// Unit of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Dimensionless number: share, ratio, number of harmonics.
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
    /// Damping coefficient of a translation.
    NewtonSecondPerMetre,
    /// Damping coefficient of a rotation.
    NewtonMetreSecondPerRadian,
    /// Compliance.
    MetrePerNewton,
    /// Speed.
    MetrePerSecond,
    /// Angular speed.
    RadianPerSecond,
    /// Frequency.
    Hertz,
    /// Decay rate.
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
    /// Returns the symbol used in tables and files.
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

    /// Converts a value to SI with angles in radians and stress in pascals; hertz and revolutions are kept.
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
