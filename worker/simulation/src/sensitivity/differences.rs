//! Differences of what one stage or one sample says, at two places beside the one at hand.
use crate::effect::{Parameter, Place};

/// Share of a parameter's size over which a residual is differenced: geometry moves points of contact in
/// and out of touch, where a force has no second derivative; drive and load are smooth, and their curves
/// are rounded.
const GEOMETRY: f64 = 1e-7;
const CURVE: f64 = 1e-5;

/// Where a function is asked beside the place at hand, and how its values make a derivative of second
/// order.
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

    /// By decades of a coefficient, in which forces are linear.
    pub(super) const fn decades() -> Self {
        Self::central(CURVE)
    }

    /// For a parameter at a value, within its bounds, by what its effect changes.
    pub(super) fn within(place: Place, parameter: &Parameter, value: f64) -> Self {
        let share = match place {
            Place::Dynamics => GEOMETRY,
            Place::Drive | Place::Load | Place::Gauge => CURVE,
        };
        let step = share * parameter.scale;
        if value - step < parameter.lower {
            Self::one_sided(step)
        } else if value + step > parameter.upper {
            Self::one_sided(-step)
        } else {
            Self::central(step)
        }
    }
}
