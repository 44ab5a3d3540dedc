//! IMPACT: one-sided contact with a power-law spring and a damper whose coefficient grows with penetration
//! (paper, Eqs. 4 and 6).
//!
//! `f = max(0, K d^n + STEP(d, 0, 0, d_max, C) d')` for penetration `d > 0`: the force never pulls. The
//! paper's Eq. 4 has no `max(0, ..)` and would pull a rope that leaves its arc fast; the `IMPACT` function of
//! the program used for the paper cuts the force off in the same way, and the power balance accounts for the
//! energy lost by it.
use crate::math::elementary::power_law;

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

/// Contact force with its derivatives and the dissipated power.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImpactForce {
    /// Repulsive contact force, never negative \[N\].
    pub force: f64,
    /// Derivative of the contact force with respect to the penetration [N/m].
    pub by_penetration: f64,
    /// Derivative of the contact force with respect to the penetration rate [N s/m].
    pub by_rate: f64,
    /// Power dissipated by the contact damping \[W\]; if a fast rebound cuts the force off, the power that
    /// the spring loses.
    pub dissipated: f64,
}

/// Intermediate results of the contact law at one penetration and rate.
#[derive(Clone, Copy)]
struct ContactState {
    /// Repulsive contact force, never negative \[N\]; the field `lost` holds the dissipated power \[W\].
    force: f64,
    lost: f64,
    /// Part of the contact force from the spring \[N\].
    spring: f64,
    /// Share of the full damping coefficient that acts at this penetration; the field `slope` holds its
    /// derivative with respect to the penetration.
    step: f64,
    slope: f64,
}

impl ImpactForce {
    /// Returns contact force, derivatives and dissipated power, all multiplied by `share`.
    #[must_use]
    pub fn share(self, share: f64) -> Self {
        Self {
            force: self.force * share,
            by_penetration: self.by_penetration * share,
            by_rate: self.by_rate * share,
            dissipated: self.dissipated * share,
        }
    }
}

/// Coefficient or state of the contact law with respect to which the force has a closed-form derivative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DerivativeVariable {
    Stiffness,
    Damping,
    Penetration,
}

impl Impact {
    /// Evaluates the contact law at one penetration and rate without branches; negative penetration counts as
    /// zero. `power` raises the penetration to the law's exponent.
    #[expect(
        clippy::inline_always,
        reason = "loops over many places become vectors; what they do not ask for is never computed"
    )]
    #[inline(always)]
    fn pressed(&self, depth: f64, rate: f64, power: impl Fn(f64) -> f64) -> ContactState {
        let inside = if depth > 0.0 { depth } else { 0.0 };
        let spring = self.stiffness * power(inside);
        let u = inside / self.full_damping_penetration;
        let u = if u < 1.0 { u } else { 1.0 };
        let step = u * u * (3.0 - 2.0 * u);
        let damper = self.damping * step * rate;
        let sum = spring + damper;
        // what the spring gives back while the contact is torn open is lost
        let torn = -spring * rate;
        ContactState {
            force: if sum > 0.0 { sum } else { 0.0 },
            lost: if sum > 0.0 { damper * rate } else { torn },
            spring,
            step,
            slope: 6.0 * u * (1.0 - u) / self.full_damping_penetration,
        }
    }

    /// Computes the derivative of the contact force with respect to one variable; zero where the force is
    /// zero.
    pub(crate) fn derivative(&self, depth: f64, rate: f64, by: DerivativeVariable) -> f64 {
        match by {
            DerivativeVariable::Stiffness => self.force_by(depth, rate)[0],
            DerivativeVariable::Damping => self.force_by(depth, rate)[1],
            DerivativeVariable::Penetration => self.force(depth, rate).by_penetration,
        }
    }

    /// Computes the derivatives of the contact force with respect to stiffness and damping coefficient; zero
    /// where the force is zero.
    pub fn force_by(&self, depth: f64, rate: f64) -> [f64; 2] {
        #[expect(clippy::float_cmp, reason = "selects the exact special case")]
        let root = self.exponent == 1.5;
        let power = |x: f64| match x > 0.0 {
            true if root => x * x.sqrt(),
            true => power_law(x, self.exponent),
            false => 0.0,
        };
        let at = self.pressed(depth, rate, power);
        if at.force > 0.0 {
            [at.spring / self.stiffness, at.step * rate]
        } else {
            [0.0; 2]
        }
    }

    /// Computes contact force \[N\] and dissipated power \[W\] for arrays of penetrations \[m\] and rates
    /// [m/s], bit-identical to [`Self::force`].
    pub fn forces_batch(&self, [depth, rate]: [&[f64]; 2], [force, lost]: [&mut [f64]; 2]) {
        let n = depth.len();
        let (rate, force, lost) = (&rate[..n], &mut force[..n], &mut lost[..n]);
        #[expect(clippy::float_cmp, reason = "selects the exact special case")]
        if self.exponent == 1.5 {
            for i in 0..n {
                let at = self.pressed(depth[i], rate[i], |x| x * x.sqrt());
                (force[i], lost[i]) = (at.force, at.lost);
            }
        } else {
            // a power is dear, and most points touch nothing
            let power = |x: f64| {
                if x > 0.0 {
                    power_law(x, self.exponent)
                } else {
                    0.0
                }
            };
            for i in 0..n {
                let at = self.pressed(depth[i], rate[i], power);
                (force[i], lost[i]) = (at.force, at.lost);
            }
        }
    }

    /// Computes the contact force, with its derivatives, at penetration `depth` \[m\] and rate `rate` [m/s].
    #[inline]
    pub fn force(&self, depth: f64, rate: f64) -> ImpactForce {
        let at = self.pressed(depth, rate, |x| power_law(x, self.exponent));
        if at.force == 0.0 {
            return ImpactForce {
                dissipated: at.lost,
                ..ImpactForce::default()
            };
        }
        ImpactForce {
            force: at.force,
            by_penetration: self.exponent * at.spring / depth + self.damping * at.slope * rate,
            by_rate: self.damping * at.step,
            dissipated: at.lost,
        }
    }

    /// Computes the elastic energy stored in the contact at penetration `depth` \[J\].
    pub fn energy(&self, depth: f64) -> f64 {
        if depth <= 0.0 {
            return 0.0;
        }
        self.stiffness * power_law(depth, self.exponent) * depth / (self.exponent + 1.0)
    }

    /// Computes the penetration at which the spring alone carries `force` \[m\].
    pub fn depth_under(&self, force: f64) -> f64 {
        crate::math::elementary::powf(force.max(0.0) / self.stiffness, 1.0 / self.exponent)
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
    fn derivatives_match_differences() {
        for (depth, rate) in [(4e-4, 0.3), (9.9e-4, -0.2), (3e-3, 0.7)] {
            let at = LAW.force(depth, rate);
            let h = 1e-9;
            let by_depth =
                (LAW.force(depth + h, rate).force - LAW.force(depth - h, rate).force) / (2.0 * h);
            assert!((by_depth - at.by_penetration).abs() < 1e-5 * at.by_penetration.abs());
            let h = 1e-6;
            let by_rate =
                (LAW.force(depth, rate + h).force - LAW.force(depth, rate - h).force) / (2.0 * h);
            assert!((by_rate - at.by_rate).abs() < 1e-6 * at.by_rate.max(1.0));
            let energy = (LAW.energy(depth + 1e-8) - LAW.energy(depth - 1e-8)) / 2e-8;
            let spring = LAW.force(depth, 0.0).force;
            assert!((energy - spring).abs() < 1e-6 * spring);
            assert!((LAW.depth_under(spring) - depth).abs() < 1e-12);
        }
    }

    #[test]
    fn contact_never_pulls() {
        assert_eq!(LAW.force(-1e-6, 5.0), ImpactForce::default());
        let torn = LAW.force(5e-4, -1e3);
        assert!(torn.force == 0.0 && torn.by_penetration == 0.0 && torn.dissipated > 0.0);
    }
}
