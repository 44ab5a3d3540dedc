//! Unknowns of every pumping unit: stiffness and damping of its ropes and of their contact with the heads
//! (paper, section 5.1). Bounds, scale and prior knowledge of the unknowns belong to the case.
use crate::unit::Unit;
use serde::{Deserialize, Serialize};

/// Unknown stiffness or damping of the ropes or of their contact with the heads; the order is that of the
/// paper's chromosome and of a case's unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Coefficient {
    /// Axial stiffness of a bushing, `K_11`.
    Kb1,
    /// Shear stiffness of a bushing, `K_22 = K_33`.
    Kb23,
    /// Torsional stiffness of a bushing, `K_44`.
    Kb4,
    /// Bending stiffness of a bushing, `K_55 = K_66`.
    Kb56,
    /// Axial damping of a bushing, `C_11`.
    Cb1,
    /// Shear damping of a bushing, `C_22 = C_33`.
    Cb23,
    /// Torsional damping of a bushing, `C_44`.
    Cb4,
    /// Bending damping of a bushing, `C_55 = C_66`.
    Cb56,
    /// Stiffness `K_c` of the contact between rope and heads.
    Kc,
    /// Largest damping `C_c` of the contact between rope and heads.
    Cc,
}

impl Coefficient {
    /// All coefficients of rope and contact, in the order of the paper's chromosome.
    pub const ALL: [Self; 10] = [
        Self::Kb1,
        Self::Kb23,
        Self::Kb4,
        Self::Kb56,
        Self::Cb1,
        Self::Cb23,
        Self::Cb4,
        Self::Cb56,
        Self::Kc,
        Self::Cc,
    ];

    /// Returns the coefficient with a name as in [`Coefficient::as_str`].
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.as_str() == name)
    }

    /// Returns the name of the coefficient used in files and in messages to other programs.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Kb1 => "kb1",
            Self::Kb23 => "kb23",
            Self::Kb4 => "kb4",
            Self::Kb56 => "kb56",
            Self::Cb1 => "cb1",
            Self::Cb23 => "cb23",
            Self::Cb4 => "cb4",
            Self::Cb56 => "cb56",
            Self::Kc => "kc",
            Self::Cc => "cc",
        }
    }

    /// Returns a short description of the coefficient for people.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Kb1 => "axial stiffness",
            Self::Kb23 => "shear stiffness",
            Self::Kb4 => "torsional stiffness",
            Self::Kb56 => "bending stiffness",
            Self::Cb1 => "axial damping",
            Self::Cb23 => "shear damping",
            Self::Cb4 => "torsional damping",
            Self::Cb56 => "bending damping",
            Self::Kc => "contact stiffness",
            Self::Cc => "contact damping",
        }
    }

    /// Returns the SI unit in which the dynamics uses the coefficient.
    pub const fn si_unit(self) -> Unit {
        match self {
            Self::Kb1 | Self::Kb23 => Unit::NewtonPerMetre,
            Self::Kb4 | Self::Kb56 => Unit::NewtonMetrePerRadian,
            Self::Cb1 | Self::Cb23 | Self::Cc => Unit::NewtonSecondPerMetre,
            Self::Cb4 | Self::Cb56 => Unit::NewtonMetreSecondPerRadian,
            Self::Kc => Unit::NewtonPerMetreToThreeHalves,
        }
    }
}
