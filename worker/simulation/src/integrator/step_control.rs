//! Step size control by the local error of each step; knows nothing of the method but its order.
use crate::math::elementary::powf;

/// Step size controller; derives the size of each step from the local error of the step before.
#[derive(Clone, Copy, Debug)]
pub struct StepControl {
    /// Order of the method's error estimate with respect to the step size.
    pub order: f64,
    /// Target local error of a step, in units of the error norm.
    pub tolerance: f64,
    /// Longest step \[s\].
    pub longest: f64,
    /// Shortest step \[s\]; the run ends with an error if a shorter one is needed.
    pub shortest: f64,
}

impl StepControl {
    /// Returns the factor by which to change the step size after a step with local error `error`.
    pub fn factor(&self, error: f64) -> f64 {
        let ratio = self.tolerance / error.max(1e-10 * self.tolerance);
        (0.9 * powf(ratio, 1.0 / self.order)).clamp(0.2, 3.0)
    }

    /// Returns the size of the next step \[s\]; small changes are suppressed, so that the factorised
    /// iteration matrix can be reused.
    pub fn next(&self, step: f64, error: f64) -> f64 {
        let factor = self.factor(error);
        let factor = if (0.85..=1.25).contains(&factor) {
            1.0
        } else {
            factor
        };
        (step * factor).min(self.longest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_follow_the_error_and_stay_in_bounds() {
        let control = StepControl {
            order: 3.0,
            tolerance: 1.0,
            longest: 0.05,
            shortest: 1e-9,
        };
        assert_eq!(control.next(0.01, 1.0).to_bits(), 0.01_f64.to_bits());
        assert!((control.next(0.01, 8.0) - 0.0045).abs() < 1e-12);
        assert!((control.next(0.01, 1e-30) - 0.03).abs() < 1e-15);
        assert_eq!(control.next(0.04, 0.0).to_bits(), 0.05_f64.to_bits());
    }
}
