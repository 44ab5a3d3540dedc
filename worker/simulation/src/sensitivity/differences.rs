//! Differences of what one stage or one sample says, at two places beside the one at hand.
use crate::effect::Parameter;

/// Share of a parameter's size over which a residual is differenced: what is left of curvature is its
/// square, and what of rounding is far below.
pub(super) const SMOOTH: f64 = 1e-5;
/// The same where points of contact move in and out of touch: there a force has no second derivative, and
/// penetrations are small differences of large numbers.
pub(super) const TOUCHING: f64 = 1e-6;
/// The same where laws along a rope may remember: at a turn of a joint's strain hysteresis has a kink, and
/// strains are rounded at 1e-15.
pub(super) const REMEMBERING: f64 = 1e-7;

/// Where a function is asked beside the place at hand, and how its values make a derivative; what has no
/// weight is not asked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Difference {
    /// Steps from the place at hand.
    pub(super) steps: [f64; 2],
    /// Weights of the values there.
    pub(super) weights: [f64; 2],
    /// Weight of the value at hand.
    pub(super) own: f64,
}

impl Difference {
    /// Central, by steps of this size.
    pub(super) const fn central(step: f64) -> Self {
        Self {
            steps: [step, -step],
            weights: [0.5 / step, -0.5 / step],
            own: 0.0,
        }
    }

    /// To one side, by one and two steps of this size, of either sign.
    const fn one_sided(step: f64) -> Self {
        Self {
            steps: [step, 2.0 * step],
            weights: [2.0 / step, -0.5 / step],
            own: -1.5 / step,
        }
    }

    /// To one side by one step that is so small that nothing is left of curvature.
    const fn forward(step: f64) -> Self {
        Self {
            steps: [step, step],
            weights: [1.0 / step, 0.0],
            own: -1.0 / step,
        }
    }

    /// By decades of a coefficient, in which forces are linear.
    pub(super) const fn decades(remembering: bool) -> Self {
        Self::central(if remembering { REMEMBERING } else { SMOOTH })
    }

    /// For a parameter at a value, within its bounds, over a share of its size.
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
