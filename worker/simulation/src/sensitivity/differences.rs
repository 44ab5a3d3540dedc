//! Finite-difference formulas (steps and weights) for derivatives of a stage's residual or a sample's
//! readings.
use crate::effect::Parameter;

/// Relative difference step, as a share of a parameter's scale, for smooth residuals. The truncation error is
/// of the order of its square, and rounding errors are far smaller.
pub(super) const SMOOTH: f64 = 1e-5;
/// Relative difference step where contact points open or close: the force has no second derivative there, and
/// penetrations are small differences of large numbers.
pub(super) const TOUCHING: f64 = 1e-6;
/// Relative difference step where axial laws may have memory: hysteresis has a kink where the strain
/// reverses, and strains are rounded at 1e-15.
pub(super) const HYSTERETIC_STEP: f64 = 1e-7;

/// Share of the largest stress by which the difference of a measuring chain displaces it.
const DISPLACED: f64 = 1e-3;

/// Finite-difference formula: steps and weights of two neighbouring values and of the central one. Values of
/// zero weight are not evaluated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Difference {
    /// Steps of the formula from the current parameter value to the two neighbouring ones.
    pub(super) steps: [f64; 2],
    /// Weights of the function values at the two neighbouring parameter values.
    pub(super) weights: [f64; 2],
    /// Weight of the function value at the current parameter value.
    pub(super) own: f64,
}

impl Difference {
    /// Returns the central difference with the given step.
    pub(super) const fn central(step: f64) -> Self {
        Self {
            steps: [step, -step],
            weights: [0.5 / step, -0.5 / step],
            own: 0.0,
        }
    }

    /// Returns the central difference that displaces stresses \[Pa\] along their derivatives by [`DISPLACED`] of the
    /// largest one; `None` where all derivatives are zero.
    pub(super) fn displacing<'x>(
        stress: impl Iterator<Item = &'x f64>,
        by: impl Iterator<Item = &'x f64>,
    ) -> Option<Self> {
        let size = by.fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let stress = stress.fold(1.0_f64, |largest, x| largest.max(x.abs()));
        (size > 0.0).then(|| Self::central(DISPLACED * stress / size))
    }

    /// Returns the second-order one-sided difference with one and two times the given step, of either sign.
    const fn one_sided(step: f64) -> Self {
        Self {
            steps: [step, 2.0 * step],
            weights: [2.0 / step, -0.5 / step],
            own: -1.5 / step,
        }
    }

    /// Returns the first-order one-sided difference, for a step so small that the effect of curvature is
    /// negligible.
    const fn forward(step: f64) -> Self {
        Self {
            steps: [step, step],
            weights: [1.0 / step, 0.0],
            own: -1.0 / step,
        }
    }

    /// Returns the difference with respect to the decades of a coefficient, in which forces are linear;
    /// `remembering` selects the step for axial laws with memory.
    pub(super) const fn decades(remembering: bool) -> Self {
        Self::central(if remembering { HYSTERETIC_STEP } else { SMOOTH })
    }

    /// Returns a difference formula for a parameter whose steps stay within the parameter's bounds; the step
    /// is the given share of the parameter's scale.
    pub(super) fn within(parameter: &Parameter, value: f64, share: f64) -> Self {
        let step = share * parameter.scale;
        let beside = if share < SMOOTH {
            Self::forward
        } else {
            Self::one_sided
        };
        if value - step < parameter.lower {
            beside(step)
        } else if value + step > parameter.upper {
            beside(-step)
        } else {
            Self::central(step)
        }
    }
}
