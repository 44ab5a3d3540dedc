//! Unknowns with respect to which a run may be differentiated, and the resulting derivatives, as plain data.
use crate::model::description::RopeLaw;
use std::f64::consts::LN_10;

/// Coefficient of rope or contact that an optimisation varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coefficient {
    /// Axial stiffness `K_11` of the joints between cylinders.
    Kb1,
    /// Shear stiffness `K_22` of the joints between cylinders.
    Kb23,
    /// Torsional stiffness `K_44` of the joints between cylinders.
    Kb4,
    /// Bending stiffness `K_55` of the joints between cylinders.
    Kb56,
    /// Axial damping `C_11` of the joints between cylinders.
    Cb1,
    /// Shear damping `C_22` of the joints between cylinders.
    Cb23,
    /// Torsional damping `C_44` of the joints between cylinders.
    Cb4,
    /// Bending damping `C_55` of the joints between cylinders.
    Cb56,
    /// Stiffness of the contact between cylinder and head.
    Kc,
    /// Damping of the contact between cylinder and head.
    Cc,
}

impl Coefficient {
    /// All coefficients of rope and contact that the search varies.
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

    /// Returns a mutable reference to this coefficient in a rope law.
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

    /// Returns the law with this coefficient equal to 1, all others zero, and no preload.
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

    /// Returns a rope law with this coefficient changed by `decades` of its decimal logarithm, to first
    /// order.
    #[must_use]
    pub(super) fn moved(self, law: &RopeLaw, decades: f64) -> RopeLaw {
        let mut moved = *law;
        *self.of(&mut moved) *= 1.0 + LN_10 * decades;
        moved
    }
}

/// Quantity with respect to which a run is differentiated.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Coefficient of rope or contact; the derivative is with respect to its decimal logarithm.
    Coefficient(Coefficient),
    /// Parameter of an effect; the derivative is with respect to the parameter in its declared unit.
    Parameter {
        /// Identifier of the effect whose parameter is varied.
        effect: String,
        /// Name of the parameter that is varied.
        parameter: String,
        /// Values of the effect's parameters by name, in declared units, for an effect that the machine
        /// lacks; parameters not named are absent (sizes) or typical (shapes). Empty for an effect that the
        /// machine has, whose own values then apply.
        values: Vec<(String, f64)>,
    },
}

/// Reason why a derivative is unavailable, so that differences of whole runs are required.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unavailable {
    /// The requested derivative is unavailable because the effect adds coordinates that the machine lacks
    /// without it, for example the displacement of a post that is rigid without the effect.
    #[error("the effect changes the number of coordinates of the machine")]
    Coordinates,
    /// The requested derivative is unavailable because the parameter is rounded to a whole number.
    #[error("the parameter is rounded to a whole number and has no derivative")]
    Integer,
    /// The requested derivative is unavailable because no machine can be built with the perturbed parameter.
    #[error("no valid machine can be built with the parameter slightly changed")]
    NoMachine,
    /// The requested derivative is unavailable because the integration method has no implicit stages that can
    /// be differentiated.
    #[error(
        "the integration method has no stages that can be differentiated; use a Runge-Kutta method"
    )]
    Method,
    /// The requested derivative is unavailable because the tangent matrix of a stage is singular.
    #[error("the tangent matrix of a stage is singular")]
    Singular,
    /// The requested derivative is unavailable because the computed values are not finite.
    #[error("the derivative is not finite")]
    NotFinite,
}

/// Derivatives of the recorded quantities at every sample, per decade of a coefficient or per declared unit
/// of a parameter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DerivativeCurves {
    /// Derivatives of the readings of gauges 1 to 4 \[Pa\].
    pub gauge: [Vec<f64>; 4],
    /// Derivatives of the suspension point's height above its lowest design position \[m\].
    pub suspension: Vec<f64>,
    /// Derivatives of the net crank torque [N m].
    pub torque: Vec<f64>,
}

impl DerivativeCurves {
    /// Returns an iterator over all curves: gauges, suspension height, torque.
    pub(super) fn each(&self) -> impl Iterator<Item = &Vec<f64>> + Clone {
        let beside = [&self.suspension, &self.torque];
        self.gauge.iter().chain(beside)
    }

    pub(super) fn each_mut(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let beside = [&mut self.suspension, &mut self.torque];
        self.gauge.iter_mut().chain(beside)
    }
}

/// Derivative of a run with respect to one requested unknown, or the reason why there is none.
#[derive(Clone, Debug, PartialEq)]
pub enum Derivative {
    /// Derivative of every recorded quantity at every sample.
    Curves(Box<DerivativeCurves>),
    /// Zero derivative, because the unknown has no influence on the run.
    Zero,
    /// Unavailable derivative, with the reason.
    Missing(Unavailable),
}

/// Derivatives of a completed run with respect to all requested unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// Derivative with respect to each requested unknown, in the order of the request.
    pub columns: Vec<Derivative>,
    /// Number of exact matrix factorisations used to compute the derivatives.
    pub factorizations: u64,
}
