//! Step size control by the local error; knows nothing of the method but its order.
use crate::math::elementary::powf;

/// Controller of a method whose error estimate is of order `order` in the step.
#[derive(Clone, Copy, Debug)]
pub struct StepControl {
    /// Order of the error estimate.
    pub order: f64,
    /// Error that is aimed at, in units of the error norm.
    pub tolerance: f64,
    /// Longest step \[s\].
    pub longest: f64,
    /// Shortest step; below it the run ends \[s\].
    pub shortest: f64,
}

impl StepControl {
    /// Factor for the next step after an error of `error`.
    pub fn factor(&self, error: f64) -> f64 {
        let ratio = self.tolerance / error.max(1e-10 * self.tolerance);
        (0.9 * powf(ratio, 1.0 / self.order)).clamp(0.2, 3.0)
    }

    /// The next step; small changes are not made, so that a factorisation can be used again.
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
        let exactly = |step: f64, expected: f64| step.to_bits() == expected.to_bits();
        assert!(exactly(control.next(0.01, 1.0), 0.01));
        assert!((control.next(0.01, 8.0) - 0.0045).abs() < 1e-12);
        assert!(exactly(control.next(0.01, 1e-30), 0.03));
        assert!(exactly(control.next(0.04, 0.0), 0.05));
    }
}
