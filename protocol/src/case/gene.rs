//! The unknown stiffness and damping numbers of a rope and its contact (paper, section 5.1).
use crate::unit::Unit;
use serde::{Deserialize, Serialize};

/// Which number a gene is; the order is that of the paper's chromosome.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum GeneName {
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
    /// Contact stiffness `K_c`.
    Kc,
    /// Largest contact damping `C_c`.
    Cc,
}

impl GeneName {
    /// Every gene, in the order of the chromosome.
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

    /// As written in files and on the wire to other programs.
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

    /// The SI unit its value has inside the dynamics.
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

/// One unknown number with its unit and the interval to search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gene {
    /// Which number.
    pub name: GeneName,
    /// Unit of `recommended`, `lower` and `upper`.
    pub unit: Unit,
    /// Recommended value: the centre of the search.
    pub recommended: f64,
    /// Smallest value to search.
    pub lower: f64,
    /// Largest value to search.
    pub upper: f64,
}
