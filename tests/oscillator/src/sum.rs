//! Sums of complex exponentials, `Re sum_j a_j exp(s_j t)`, the form of every motion of a linear system.
use nalgebra::Complex;

/// Term of a sum of exponentials: complex amplitude and rate [1/s].
type Term = (Complex<f64>, Complex<f64>);

/// Real part of a sum of complex exponentials, a function of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sum(Vec<Term>);

impl Sum {
    /// Creates a sum with a single exponential.
    pub fn term(amplitude: Complex<f64>, rate: Complex<f64>) -> Self {
        Self(vec![(amplitude, rate)])
    }

    /// Creates a constant function.
    pub fn constant(value: f64) -> Self {
        Self::term(Complex::from(value), Complex::from(0.0))
    }

    /// Creates `amplitude cos(rate t + phase)`; rate in rad/s, phase in rad.
    pub fn cosine(amplitude: f64, rate: f64, phase: f64) -> Self {
        let turned = exp(Complex::new(0.0, phase)) * amplitude;
        Self::term(turned, Complex::new(0.0, rate))
    }

    /// Returns the value of the sum at a time \[s\].
    pub fn at(&self, t: f64) -> f64 {
        self.0.iter().map(|(a, s)| (a * exp(s * t)).re).sum()
    }

    /// Adds another sum of exponentials.
    #[must_use]
    pub fn plus(mut self, other: &Self) -> Self {
        self.0.extend_from_slice(&other.0);
        self
    }

    /// Computes the steady-state response of a linear system: each exponential times the system's transfer
    /// function at its rate.
    #[must_use]
    pub fn filtered(&self, transfer: impl Fn(Complex<f64>) -> Complex<f64>) -> Self {
        Self(self.0.iter().map(|(a, s)| (a * transfer(*s), *s)).collect())
    }

    /// Computes the time derivative of the sum.
    #[must_use]
    pub fn rate(&self) -> Self {
        self.filtered(|s| s)
    }

    /// Shifts the time origin of the sum to `t` \[s\].
    #[must_use]
    pub fn since(&self, t: f64) -> Self {
        self.filtered(|s| exp(s * t))
    }

    /// Returns the greatest angular frequency among the exponentials of the sum [rad/s].
    pub fn fastest(&self) -> f64 {
        self.0.iter().map(|(_, s)| s.im.abs()).fold(0.0, f64::max)
    }
}

/// Computes the complex exponential with the same bits on every processor.
fn exp(z: Complex<f64>) -> Complex<f64> {
    let (sine, cosine) = libm::sincos(z.im);
    Complex::new(cosine, sine) * libm::exp(z.re)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_is_the_function_that_it_stands_for() {
        let f = Sum::cosine(3.0, 7.0, 0.4).plus(&Sum::constant(-2.0));
        let expected = |t: f64| 3.0 * (7.0 * t + 0.4).cos() - 2.0;
        for t in [0.0, 0.13, 2.7] {
            assert!((f.at(t) - expected(t)).abs() < 1e-12);
            let slope = -21.0 * (7.0 * t + 0.4).sin();
            assert!((f.rate().at(t) - slope).abs() < 1e-12);
            assert!((f.since(0.8).at(t) - expected(t + 0.8)).abs() < 1e-12);
        }
        assert!((f.fastest() - 7.0).abs() < f64::EPSILON);
    }
}
