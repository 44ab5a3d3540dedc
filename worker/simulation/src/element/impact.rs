//! IMPACT: one-sided contact with a power-law spring and a damper that is ramped in (paper,
//! Eqs. 4 and 6).
//!
//! `f = max(0, K d^n + STEP(d, 0, 0, d_max, C) d')` for penetration `d > 0`: the force never pulls.
use crate::math::elementary::power_law;

/// Coefficients of a contact, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Spring coefficient K [N/m^n].
    pub stiffness: f64,
    /// Exponent n of the penetration.
    pub exponent: f64,
    /// Largest damping C [N s/m].
    pub damping: f64,
    /// Penetration at which the damping is fully there, `d_max` \[m\].
    pub full_damping_penetration: f64,
}

/// Contact force and its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImpactForce {
    /// Force that pushes apart, never negative \[N\].
    pub force: f64,
    /// Derivative by the penetration [N/m].
    pub by_penetration: f64,
    /// Derivative by its rate [N s/m].
    pub by_rate: f64,
    /// Power that the damping takes \[W\]; negative on rebound only while the spring exceeds it.
    pub dissipated: f64,
}

impl Impact {
    /// Spring force, and the damping's ramp with its slope.
    #[inline]
    fn parts(&self, depth: f64) -> (f64, f64, f64) {
        let spring = self.stiffness * power_law(depth, self.exponent);
        if depth >= self.full_damping_penetration {
            return (spring, 1.0, 0.0);
        }
        let u = depth / self.full_damping_penetration;
        let slope = 6.0 * u * (1.0 - u) / self.full_damping_penetration;
        (spring, u * u * (3.0 - 2.0 * u), slope)
    }

    /// Force \[N\] at penetration `depth` \[m\] and rate `rate` [m/s], and the power that the damping
    /// takes \[W\].
    #[inline]
    pub fn push(&self, depth: f64, rate: f64) -> (f64, f64) {
        if depth <= 0.0 {
            return (0.0, 0.0);
        }
        let (spring, step, _) = self.parts(depth);
        let damper = self.damping * step * rate;
        let force = spring + damper;
        if force <= 0.0 {
            // what the spring gives back while the contact is torn open is lost
            return (0.0, -spring * rate);
        }
        (force, damper * rate)
    }

    /// [`Self::push`] at many places, to the bit: forces and powers.
    pub fn push_all(&self, [depth, rate]: [&[f64]; 2], [force, lost]: [&mut [f64]; 2]) {
        let n = depth.len();
        #[expect(clippy::float_cmp, reason = "selects the exact special case")]
        if self.exponent != 1.5 {
            for i in 0..n {
                (force[i], lost[i]) = self.push(depth[i], rate[i]);
            }
            return;
        }
        // without branches: where there is no contact, the penetration counts as zero
        let (rate, force, lost) = (&rate[..n], &mut force[..n], &mut lost[..n]);
        for i in 0..n {
            let inside = if depth[i] > 0.0 { depth[i] } else { 0.0 };
            let spring = self.stiffness * (inside * inside.sqrt());
            let u = inside / self.full_damping_penetration;
            let u = if u < 1.0 { u } else { 1.0 };
            let damper = self.damping * (u * u * (3.0 - 2.0 * u)) * rate[i];
            let sum = spring + damper;
            let torn = -spring * rate[i];
            force[i] = if sum > 0.0 { sum } else { 0.0 };
            lost[i] = if sum > 0.0 { damper * rate[i] } else { torn };
        }
    }

    /// [`Self::push`] with its derivatives.
    #[inline]
    pub fn force(&self, depth: f64, rate: f64) -> ImpactForce {
        let (force, dissipated) = self.push(depth, rate);
        if force == 0.0 {
            return ImpactForce {
                dissipated,
                ..ImpactForce::default()
            };
        }
        let (spring, step, slope) = self.parts(depth);
        ImpactForce {
            force,
            by_penetration: self.exponent * spring / depth + self.damping * slope * rate,
            by_rate: self.damping * step,
            dissipated,
        }
    }

    /// Energy stored at penetration `depth` \[J\].
    pub fn energy(&self, depth: f64) -> f64 {
        if depth <= 0.0 {
            return 0.0;
        }
        self.stiffness * power_law(depth, self.exponent) * depth / (self.exponent + 1.0)
    }

    /// Penetration at which the spring alone carries `force` \[m\].
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
