//! Selectable integration methods.
use super::bdf::Bdf;
use super::esdirk::Esdirk;
use super::generalized_alpha::GeneralizedAlpha;
use super::rosenbrock::Rosenbrock;
use super::stepper::Stepper;
use super::tableau::{ESDIRK4, TR_BDF2, Tableau};
use crate::system::{Equations, System};

/// Selectable integration method.
#[derive(Clone, Copy, Debug)]
pub enum Method {
    /// Singly diagonally implicit Runge-Kutta method with an explicit first stage, given by its coefficients.
    RungeKutta(&'static Tableau),
    /// RODAS: a Rosenbrock method of order 4, which solves linear systems instead of iterating with Newton's
    /// method.
    Rosenbrock,
    /// Generalised-alpha of Chung and Hulbert, order 2.
    GeneralizedAlpha {
        /// Spectral radius at infinite frequency, from 0 (unresolved modes are annihilated in one step) to 1
        /// (no damping).
        spectral_radius: f64,
    },
    /// Backward differentiation formulas of variable step and order.
    Bdf {
        /// Highest order of the formulas used, 1 to 5.
        highest: usize,
    },
}

/// Default spectral radius at infinite frequency of the generalised-alpha method: damps unresolved modes
/// within a few steps and hardly affects resolved ones.
pub const SPECTRAL_RADIUS: f64 = 0.5;

/// All integration methods that can be selected, with their default settings.
pub static CATALOGUE: [Method; 5] = [
    Method::RungeKutta(&TR_BDF2),
    Method::RungeKutta(&ESDIRK4),
    Method::Rosenbrock,
    Method::GeneralizedAlpha {
        spectral_radius: SPECTRAL_RADIUS,
    },
    Method::Bdf { highest: 2 },
];

impl Method {
    /// Returns the method's name, as printed in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::RungeKutta(tableau) => tableau.name,
            Self::Rosenbrock => "rodas4",
            Self::GeneralizedAlpha { .. } => "generalized-alpha",
            Self::Bdf { highest: 1 } => "bdf, order 1",
            Self::Bdf { highest: 2 } => "bdf, order <= 2",
            Self::Bdf { highest: 3 } => "bdf, order <= 3",
            Self::Bdf { highest: 4 } => "bdf, order <= 4",
            Self::Bdf { .. } => "bdf, order <= 5",
        }
    }

    /// Returns the order of accuracy; for a variable-order method, the highest one.
    pub const fn order(self) -> usize {
        match self {
            Self::RungeKutta(tableau) => tableau.order as usize,
            Self::Rosenbrock => 4,
            Self::GeneralizedAlpha { .. } => 2,
            Self::Bdf { highest } => highest,
        }
    }

    /// Creates the method with buffers for a system and the local error allowed per step.
    pub fn stepper<E: Equations>(self, system: &System<E>, tolerance: f64) -> Box<dyn Stepper<E>> {
        let n = system.len();
        match self {
            Self::RungeKutta(tableau) => Box::new(Esdirk::new(tableau, n, tolerance)),
            Self::Rosenbrock => Box::new(Rosenbrock::new(system.equations.matrix())),
            Self::GeneralizedAlpha { spectral_radius } => {
                Box::new(GeneralizedAlpha::new(spectral_radius, n, tolerance))
            }
            Self::Bdf { highest } => Box::new(Bdf::new(highest, n, tolerance)),
        }
    }
}

impl From<&'static Tableau> for Method {
    fn from(tableau: &'static Tableau) -> Self {
        Self::RungeKutta(tableau)
    }
}
