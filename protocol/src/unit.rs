//! Units that case files may state, and the only conversion to SI in the workspace.
//!
//! A [`Unit`] is data: it travels with its value and knows nothing of the value's meaning. The reference
//! paper gives rotational stiffness per degree (`N m/deg`), so `value_si = value * 180 / pi` for those.
use serde::{Deserialize, Serialize};

/// A unit that the program can convert.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Unit {
    /// Translational stiffness [N/m].
    #[serde(rename = "N/m")]
    NewtonPerMetre,
    /// Rotational stiffness [N m/rad].
    #[serde(rename = "N.m/rad")]
    NewtonMetrePerRadian,
    /// Rotational stiffness per degree [N m/deg].
    #[serde(rename = "N.m/deg")]
    NewtonMetrePerDegree,
    /// Translational damping [N s/m].
    #[serde(rename = "N.s/m")]
    NewtonSecondPerMetre,
    /// Rotational damping [N m s/rad].
    #[serde(rename = "N.m.s/rad")]
    NewtonMetreSecondPerRadian,
    /// Rotational damping per degree [N m s/deg].
    #[serde(rename = "N.m.s/deg")]
    NewtonMetreSecondPerDegree,
    /// Contact stiffness with exponent 1.5 [N/m^1.5].
    #[serde(rename = "N/m^1.5")]
    NewtonPerMetreToThreeHalves,
}

impl Unit {
    /// All units, in the order in which error messages list them.
    pub const ALL: [Self; 7] = [
        Self::NewtonPerMetre,
        Self::NewtonMetrePerRadian,
        Self::NewtonMetrePerDegree,
        Self::NewtonSecondPerMetre,
        Self::NewtonMetreSecondPerRadian,
        Self::NewtonMetreSecondPerDegree,
        Self::NewtonPerMetreToThreeHalves,
    ];

    /// Returns the unit with the given symbol.
    pub fn named(symbol: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.symbol() == symbol)
    }

    /// Returns the symbol of the unit used in case files and tables.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::NewtonPerMetre => "N/m",
            Self::NewtonMetrePerRadian => "N.m/rad",
            Self::NewtonMetrePerDegree => "N.m/deg",
            Self::NewtonSecondPerMetre => "N.s/m",
            Self::NewtonMetreSecondPerRadian => "N.m.s/rad",
            Self::NewtonMetreSecondPerDegree => "N.m.s/deg",
            Self::NewtonPerMetreToThreeHalves => "N/m^1.5",
        }
    }

    /// Returns the factor that converts a value of this unit to SI (radians, metres, newtons, seconds).
    pub const fn si_factor(self) -> f64 {
        match self {
            Self::NewtonMetrePerDegree | Self::NewtonMetreSecondPerDegree => {
                180.0 / std::f64::consts::PI
            }
            Self::NewtonPerMetre
            | Self::NewtonMetrePerRadian
            | Self::NewtonSecondPerMetre
            | Self::NewtonMetreSecondPerRadian
            | Self::NewtonPerMetreToThreeHalves => 1.0,
        }
    }

    /// Returns the SI unit of a value after [`Unit::to_si`]: the unit per radian in place of per degree.
    #[must_use]
    pub const fn si(self) -> Self {
        match self {
            Self::NewtonMetrePerDegree => Self::NewtonMetrePerRadian,
            Self::NewtonMetreSecondPerDegree => Self::NewtonMetreSecondPerRadian,
            other @ (Self::NewtonPerMetre
            | Self::NewtonMetrePerRadian
            | Self::NewtonSecondPerMetre
            | Self::NewtonMetreSecondPerRadian
            | Self::NewtonPerMetreToThreeHalves) => other,
        }
    }

    /// Converts a value of this unit to SI.
    pub const fn to_si(self, value: f64) -> f64 {
        value * self.si_factor()
    }
}
