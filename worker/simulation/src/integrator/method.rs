//! Selectable integration methods.
#[cfg(feature = "comparison")]
use super::bdf::Bdf;
use super::esdirk::Esdirk;
#[cfg(feature = "comparison")]
use super::generalized_alpha::GeneralizedAlpha;
#[cfg(feature = "comparison")]
use super::rosenbrock::Rosenbrock;
use super::stepper::Stepper;
use super::tableau::Tableau;
#[cfg(feature = "comparison")]
use super::tableau::{ESDIRK4, TR_BDF2};
use crate::system::{Equations, System};

/// Selectable integration method.
#[derive(Clone, Copy, Debug)]
pub enum Method {
    /// Singly diagonally implicit Runge-Kutta method with an explicit first stage, given by its coefficients.
    RungeKutta(&'static Tableau),
    /// RODAS: a Rosenbrock method of order 4, which solves linear systems instead of iterating with Newton's
    /// method.
    #[cfg(feature = "comparison")]
    Rosenbrock,
    /// Generalised-alpha of Chung and Hulbert, order 2.
    #[cfg(feature = "comparison")]
    GeneralizedAlpha {
        /// Spectral radius at infinite frequency, from 0 (unresolved modes are annihilated in one step) to 1
        /// (no damping).
        spectral_radius: f64,
    },
    /// Backward differentiation formulas of variable step and order.
    #[cfg(feature = "comparison")]
    Bdf {
        /// Highest order of the formulas used, 1 or 2.
        highest: usize,
    },
}

/// Default spectral radius at infinite frequency of the generalised-alpha method: damps unresolved modes
/// within a few steps and hardly affects resolved ones.
#[cfg(feature = "comparison")]
pub const SPECTRAL_RADIUS: f64 = 0.5;

/// All integration methods that can be selected, with their default settings.
#[cfg(feature = "comparison")]
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
            #[cfg(feature = "comparison")]
            Self::Rosenbrock => "rodas4",
            #[cfg(feature = "comparison")]
            Self::GeneralizedAlpha { .. } => "generalized-alpha",
            #[cfg(feature = "comparison")]
            Self::Bdf { highest: 1 } => "bdf, order 1",
            #[cfg(feature = "comparison")]
            Self::Bdf { .. } => "bdf, order <= 2",
        }
    }

    /// Returns the order of accuracy; for a variable-order method, the highest one.
    pub const fn order(self) -> usize {
        match self {
            Self::RungeKutta(tableau) => tableau.order as usize,
            #[cfg(feature = "comparison")]
            Self::Rosenbrock => 4,
            #[cfg(feature = "comparison")]
            Self::GeneralizedAlpha { .. } => 2,
            #[cfg(feature = "comparison")]
            Self::Bdf { highest } => highest,
        }
    }

    /// Returns the coefficients of a Runge-Kutta method; `None` for a method of another kind.
    pub const fn tableau(self) -> Option<&'static Tableau> {
        match self {
            Self::RungeKutta(tableau) => Some(tableau),
            #[cfg(feature = "comparison")]
            Self::Rosenbrock | Self::GeneralizedAlpha { .. } | Self::Bdf { .. } => None,
        }
    }

    /// Creates the method with buffers for a system and the local error allowed per step.
    pub fn stepper<E: Equations>(self, system: &System<E>, tolerance: f64) -> Box<dyn Stepper<E>> {
        let n = system.len();
        match self {
            Self::RungeKutta(tableau) => Box::new(Esdirk::new(tableau, n, tolerance)),
            #[cfg(feature = "comparison")]
            Self::Rosenbrock => Box::new(Rosenbrock::new(system.equations.matrix())),
            #[cfg(feature = "comparison")]
            Self::GeneralizedAlpha { spectral_radius } => {
                Box::new(GeneralizedAlpha::new(spectral_radius, n, tolerance))
            }
            #[cfg(feature = "comparison")]
            Self::Bdf { highest } => Box::new(Bdf::new(highest, n, tolerance)),
        }
    }
}

impl From<&'static Tableau> for Method {
    fn from(tableau: &'static Tableau) -> Self {
        Self::RungeKutta(tableau)
    }
}
