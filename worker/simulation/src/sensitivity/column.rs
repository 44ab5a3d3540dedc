//! What may be varied, and what is known of it afterwards: plain data.
use crate::model::description::RopeLaw;
use std::f64::consts::LN_10;

/// A searched coefficient of the ropes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coefficient {
    /// Axial stiffness `K_11`.
    Kb1,
    /// Shear stiffness `K_22`.
    Kb23,
    /// Torsional stiffness `K_44`.
    Kb4,
    /// Bending stiffness `K_55`.
    Kb56,
    /// Axial damping `C_11`.
    Cb1,
    /// Shear damping `C_22`.
    Cb23,
    /// Torsional damping `C_44`.
    Cb4,
    /// Bending damping `C_55`.
    Cb56,
    /// Stiffness of the contact.
    Kc,
    /// Damping of the contact.
    Cc,
}

impl Coefficient {
    /// All of them.
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

    /// The coefficient among those of a law.
    pub const fn of(self, law: &mut RopeLaw) -> &mut f64 {
        let RopeLaw { bushing, contact } = law;
        match self {
            Self::Kb1 => &mut bushing.stiffness[0],
            Self::Kb23 => &mut bushing.stiffness[1],
            Self::Kb4 => &mut bushing.rotational_stiffness[0],
            Self::Kb56 => &mut bushing.rotational_stiffness[1],
            Self::Cb1 => &mut bushing.damping[0],
            Self::Cb23 => &mut bushing.damping[1],
            Self::Cb4 => &mut bushing.rotational_damping[0],
            Self::Cb56 => &mut bushing.rotational_damping[1],
            Self::Kc => &mut contact.stiffness,
            Self::Cc => &mut contact.damping,
        }
    }

    /// The law with a coefficient of 1 and no other, and no preload.
    pub(super) const fn unit(self, law: &RopeLaw) -> RopeLaw {
        let mut unit = *law;
        unit.bushing.preload = 0.0;
        let mut k = 0;
        while k < Self::ALL.len() {
            *Self::ALL[k].of(&mut unit) = 0.0;
            k += 1;
        }
        *self.of(&mut unit) = 1.0;
        unit
    }

    /// A law with this coefficient moved by so many decades, to first order.
    #[must_use]
    pub(super) fn moved(self, law: &RopeLaw, decades: f64) -> RopeLaw {
        let mut moved = *law;
        *self.of(&mut moved) *= 1.0 + LN_10 * decades;
        moved
    }
}

/// What is varied.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// A coefficient of the ropes; the derivative is by its decimal logarithm.
    Coefficient(Coefficient),
    /// A parameter of an effect; the derivative is by the parameter in its declared unit.
    Parameter {
        /// Identifier of the effect.
        effect: String,
        /// Name of the parameter.
        parameter: String,
        /// Values of the effect's parameters by name, in declared units, where the machine does not
        /// have the effect: what is not named is absent (sizes) or typical (shapes). Empty where the
        /// machine has it: then its own values hold.
        values: Vec<(String, f64)>,
    },
}

/// Why a column does not exist, and differences of whole runs must do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Missing {
    /// With the effect the machine has coordinates that it does not have without: a post that does not
    /// yield has no displacement.
    #[error("without the effect the machine lacks coordinates that it has with it")]
    Coordinates,
    /// The parameter is rounded to a whole number.
    #[error("the parameter counts by whole numbers")]
    Whole,
    /// No machine can be built beside the one at hand.
    #[error("no machine can be built with the parameter a little off")]
    NoMachine,
    /// The method of integration has no stages to differentiate.
    #[error("the method of integration has no stages that could be differentiated")]
    Method,
    /// A stage's exact tangent is singular.
    #[error("a tangent on the way is singular")]
    Singular,
    /// A derivative left the range of numbers.
    #[error("the derivative is no number")]
    NotFinite,
}

/// Derivatives of what is read at every sample, per decade or per the parameter's declared unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// Of gauges 1 to 4 \[Pa\].
    pub gauge: [Vec<f64>; 4],
    /// Of the height of the suspension point above its lowest design position \[m\].
    pub suspension: Vec<f64>,
    /// Of the net crank torque [N m].
    pub torque: Vec<f64>,
}

impl Changes {
    /// Every curve.
    pub(super) fn each(&self) -> impl Iterator<Item = &Vec<f64>> + Clone {
        let beside = [&self.suspension, &self.torque];
        self.gauge.iter().chain(beside)
    }

    /// The same.
    pub(super) fn each_mut(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let beside = [&mut self.suspension, &mut self.torque];
        self.gauge.iter_mut().chain(beside)
    }
}

/// One column.
#[derive(Clone, Debug, PartialEq)]
pub enum Derivative {
    /// It has one.
    Curves(Box<Changes>),
    /// The parameter does nothing: zeros.
    Nothing,
    /// There is none.
    Missing(Missing),
}

/// What a completed run gives besides its curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// One for each column that was asked for, in their order.
    pub columns: Vec<Derivative>,
    /// Exact factorisations that they took.
    pub factorizations: u64,
}
