//! Units of effect parameters, with their symbols and their conversion to SI.

/// Unit of a parameter of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Dimensionless number: share, ratio, number of harmonics.
    One,
    /// Metre, for lengths.
    Metre,
    /// Second, for times.
    Second,
    /// Degree, for angles.
    Degree,
    /// Newton, for forces.
    Newton,
    /// Newton metre, for moments.
    NewtonMetre,
    /// N s/m, for damping coefficients of translations.
    NewtonSecondPerMetre,
    /// N m s/rad, for damping coefficients of rotations.
    NewtonMetreSecondPerRadian,
    /// m/N, for compliances.
    MetrePerNewton,
    /// m/s, for speeds.
    MetrePerSecond,
    /// rad/s, for angular speeds.
    RadianPerSecond,
    /// Hertz, for frequencies.
    Hertz,
    /// 1/s, for decay rates.
    PerSecond,
    /// Kilogram, for masses.
    Kilogram,
    /// kg m2, for moments of inertia.
    KilogramSquareMetre,
    /// Megapascal, for stresses.
    Megapascal,
    /// `MPa` per revolution of the crank, for drifts of a stress reading.
    MegapascalPerRevolution,
    /// MPa/m, for stress per length.
    MegapascalPerMetre,
    /// N/kg^0.5, for forces on mass-normalised modal coordinates.
    ModalNewton,
}

impl Unit {
    /// Returns the unit's symbol, as used in tables and files.
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
