//! IMPACT: one-sided contact with a power-law spring and a damper whose coefficient grows with penetration
//! (paper, Eqs. 4 and 6).
//!
//! `f = max(0, K d^n + STEP(d, 0, 0, d_max, C) d')` for penetration `d > 0`: the force never pulls. The
//! paper's Eq. 4 has no `max(0, ..)` and would pull a rope that leaves its arc fast; the `IMPACT` function of
//! the program used for the paper cuts the force off in the same way, and the power balance accounts for the
//! energy lost by it.
use super::law::{ForceLaw, LawResponse};
use crate::math::elementary::powf;
use crate::math::real::Real;

/// Coefficients of the contact force law, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Spring coefficient K [N/m^n].
    pub stiffness: f64,
    /// Exponent n of the penetration.
    pub exponent: f64,
    /// Largest damping coefficient C of the contact, reached at full penetration [N s/m].
    pub damping: f64,
    /// Penetration `d_max` from which the full damping coefficient acts \[m\].
    pub full_damping_penetration: f64,
}

/// Coefficient or state of the contact law with respect to which the force has a closed-form derivative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DerivativeVariable {
    Stiffness,
    Damping,
    Penetration,
}

/// Intermediate results of the contact law at one penetration and rate.
#[derive(Clone, Copy)]
struct ContactState<T> {
    /// Penetration, zero outside the surface \[m\], its power by the law's exponent, and the derivative of
    /// that power.
    inside: T,
    power: T,
    slope: T,
    /// Share of the full damping coefficient that acts at this penetration, and its derivative [1/m].
    step: T,
    step_slope: T,
    /// Force of spring and damper together \[N\]; where it is negative, the contact is torn open.
    sum: T,
}

impl Impact {
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions; what is not used is not computed"
    )]
    #[inline(always)]
    fn state<T: Real>(&self, depth: T, rate: T) -> ContactState<T> {
        let zero = depth.constant(0.0);
        let inside = zero.select_less(depth, depth, zero);
        #[expect(clippy::float_cmp, reason = "selects the exact special case")]
        let [power, slope] = if self.exponent == 1.5 {
            let root = inside.sqrt();
            [inside * root, root * 1.5]
        } else {
            // a power is dear, and most points touch nothing
            inside.each(|x| {
                if x > 0.0 {
                    let power = powf(x, self.exponent);
                    [power, self.exponent * power / x]
                } else {
                    [0.0; 2]
                }
            })
        };
        let full = 1.0 / self.full_damping_penetration;
        let u = (inside * full).at_most(zero.constant(1.0));
        let step = u * u * (u * -2.0 + 3.0);
        ContactState {
            inside,
            power,
            slope,
            step,
            step_slope: u * (zero.constant(1.0) - u) * (6.0 * full),
            sum: power * self.stiffness + step * rate * self.damping,
        }
    }

    /// Returns the derivative of the contact force with respect to one variable; zero where the force is
    /// zero.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub(crate) fn derivative<T: Real>(&self, depth: T, rate: T, by: DerivativeVariable) -> T {
        let [[by_stiffness], [by_damping]] = self.by_coefficients([depth], [rate]);
        match by {
            DerivativeVariable::Stiffness => by_stiffness,
            DerivativeVariable::Damping => by_damping,
            DerivativeVariable::Penetration => self.response([depth], [rate]).stiffness[0][0],
        }
    }

    /// Returns the penetration at which the spring alone carries `force` \[m\].
    pub fn depth_under(&self, force: f64) -> f64 {
        powf(force.max(0.0) / self.stiffness, 1.0 / self.exponent)
    }
}

/// Law of the penetration \[m\], with the coefficients K and C.
impl ForceLaw<1, 2> for Impact {
    fn coefficients(&self) -> [f64; 2] {
        [self.stiffness, self.damping]
    }

    fn with_coefficients(&self, [stiffness, damping]: [f64; 2]) -> Self {
        Self {
            stiffness,
            damping,
            ..*self
        }
    }

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn response<T: Real>(&self, [depth]: [T; 1], [rate]: [T; 1]) -> LawResponse<T, 1> {
        let at = self.state(depth, rate);
        let zero = depth.constant(0.0);
        let pressed = |value: T, torn: T| zero.select_less(at.sum, value, torn);
        let spring = at.power * self.stiffness;
        let damper = at.step * rate * self.damping;
        let by_depth = at.slope * self.stiffness + at.step_slope * rate * self.damping;
        LawResponse {
            force: [pressed(at.sum, zero)],
            stiffness: [[pressed(by_depth, zero)]],
            damping: [[pressed(at.step * self.damping, zero)]],
            energy: spring * at.inside * (1.0 / (self.exponent + 1.0)),
            // what the spring gives back while the contact is torn open is lost
            dissipated: pressed(damper * rate, -spring * rate),
        }
    }

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn by_coefficients<T: Real>(&self, [depth]: [T; 1], [rate]: [T; 1]) -> [[T; 1]; 2] {
        let at = self.state(depth, rate);
        let zero = depth.constant(0.0);
        let pressed = |value: T| zero.select_less(at.sum, value, zero);
        [[pressed(at.power)], [pressed(at.step * rate)]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Impact = Impact {
        stiffness: 3.0e6,
        exponent: 1.7,
        damping: 40.0,
        full_damping_penetration: 1e-3,
    };

    #[test]
    fn contact_never_pulls() {
        let apart = LAW.response([-1e-6], [5.0]);
        assert!(apart.force[0].abs() + apart.dissipated.abs() < f64::MIN_POSITIVE);
        let torn = LAW.response([5e-4], [-1e3]);
        assert_eq!(
            [torn.force[0], torn.stiffness[0][0]].map(f64::to_bits),
            [0; 2]
        );
        assert!(torn.dissipated > 0.0);
    }

    #[test]
    fn spring_carries_its_force_at_its_depth() {
        for depth in [4e-4, 9.9e-4, 3e-3] {
            let [spring] = LAW.response([depth], [0.0]).force;
            assert!((LAW.depth_under(spring) - depth).abs() < 1e-12);
        }
    }
}
