//! The unknown numbers of a case: stiffness and damping of a rope and its contact (paper, section
//! 5.1), and parameters of the case's effects.
use crate::unit::Unit;
use serde::{Deserialize, Serialize};

/// A coefficient of rope or contact; the order is that of the paper's chromosome.
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
    /// Contact stiffness `K_c`.
    Kc,
    /// Largest contact damping `C_c`.
    Cc,
}

impl Coefficient {
    /// Every coefficient, in the order of the chromosome.
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

/// What a gene is a number of, and its unit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Quantity {
    /// A coefficient of rope or contact.
    Coefficient {
        /// Which one.
        name: Coefficient,
        /// Its unit.
        unit: Unit,
    },
    /// A parameter of one of the case's effects.
    Effect {
        /// Identifier of the effect.
        id: String,
        /// Name of the parameter within the effect.
        parameter: String,
        /// Unit that the effect takes it in, one of [`crate::unit::EFFECT_UNITS`].
        unit: String,
    },
}

/// How equal steps of a search change a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// By equal factors: what is positive and known to an order of magnitude.
    Logarithmic,
    /// By equal amounts: what may be zero or negative.
    Linear,
}

/// One unknown number with the interval to search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gene {
    /// What it is a number of, and the unit of the values below.
    pub quantity: Quantity,
    /// Recommended value: the centre of the search.
    pub recommended: f64,
    /// Smallest value to search.
    pub lower: f64,
    /// Largest value to search.
    pub upper: f64,
}

impl Quantity {
    /// Its name in files and tables: `kb1`, or effect and parameter as `rope_stretch.stretch`.
    pub fn label(&self) -> String {
        match self {
            Self::Coefficient { name, .. } => name.as_str().to_owned(),
            Self::Effect { id, parameter, .. } => format!("{id}.{parameter}"),
        }
    }

    /// Symbol of its unit, as written in files.
    pub fn unit(&self) -> &str {
        match self {
            Self::Coefficient { unit, .. } => unit.symbol(),
            Self::Effect { unit, .. } => unit,
        }
    }

    /// On what scale it is searched: coefficients are positive, parameters of effects may be 0.
    pub const fn scale(&self) -> Scale {
        match self {
            Self::Coefficient { .. } => Scale::Logarithmic,
            Self::Effect { .. } => Scale::Linear,
        }
    }

    /// Whether it is this coefficient.
    pub fn is(&self, coefficient: Coefficient) -> bool {
        matches!(self, Self::Coefficient { name, .. } if *name == coefficient)
    }

    /// Whether it is a parameter of an effect.
    pub const fn is_of_effect(&self) -> bool {
        matches!(self, Self::Effect { .. })
    }
}

impl Gene {
    /// A coefficient with its recommended value and bounds.
    pub const fn coefficient(
        name: Coefficient,
        unit: Unit,
        recommended: f64,
        [lower, upper]: [f64; 2],
    ) -> Self {
        Self {
            quantity: Quantity::Coefficient { name, unit },
            recommended,
            lower,
            upper,
        }
    }

    /// Its name in files and tables; see [`Quantity::label`].
    pub fn label(&self) -> String {
        self.quantity.label()
    }

    /// Symbol of the unit of its values.
    pub fn unit(&self) -> &str {
        self.quantity.unit()
    }

    /// On what scale it is searched.
    pub const fn scale(&self) -> Scale {
        self.quantity.scale()
    }
}
