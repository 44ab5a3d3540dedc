//! Fourier coefficients of curves over one period, called orders.
//!
//! `F_h = (1/n) sum_i y_i exp(-i h phi_i)`, so the mean square of a curve about its mean is `2 sum_h
//! |F_h|^2`.
use nalgebra::Complex;
use std::f64::consts::TAU;

/// Basis coefficients (orders or innovations) of curves, channel by channel.
pub type Spectra = Vec<Vec<Complex<f64>>>;

/// Discrete Fourier transform on a grid of equally spaced phases, from 0 on, without the end of the period.
#[derive(Clone, Debug)]
pub struct Orders {
    highest: usize,
    /// Phasors `exp(-i phi)` at the phases of the grid.
    turn: Vec<Complex<f64>>,
}

impl Orders {
    /// Creates the transform for curves of `n` samples and orders 1 to `highest`, at most half the samples.
    pub fn new(n: usize, highest: usize) -> Self {
        let unit = |i: usize| {
            let (sine, cosine) = libm::sincos(TAU * i as f64 / n as f64);
            Complex::new(cosine, -sine)
        };
        Self {
            highest: highest.min(n / 2),
            turn: (0..n).map(unit).collect(),
        }
    }

    /// Returns the highest order; orders are counted from 1.
    pub const fn highest(&self) -> usize {
        self.highest
    }

    /// Returns the number of samples of a curve.
    pub fn samples(&self) -> usize {
        self.turn.len()
    }

    /// Returns the Fourier coefficient of one order for a curve of [`Self::samples`] values.
    pub fn coefficient(&self, curve: &[f64], order: usize) -> Complex<f64> {
        let n = self.turn.len();
        let mut sum = Complex::new(0.0, 0.0);
        let mut at = 0;
        for value in curve {
            sum += self.turn[at] * *value;
            at += order;
            if at >= n {
                at -= n;
            }
        }
        sum / n as f64
    }

    /// Returns the Fourier coefficients of a curve, from order 1 to the highest.
    pub fn transform(&self, curve: &[f64]) -> Vec<Complex<f64>> {
        (1..=self.highest)
            .map(|order| self.coefficient(curve, order))
            .collect()
    }

    /// Returns the curve, without its mean, that has the given Fourier coefficients.
    pub fn curve(&self, coefficients: &[Complex<f64>]) -> Vec<f64> {
        let n = self.turn.len();
        let value = |i: usize| -> f64 {
            let part = |(k, f): (usize, &Complex<f64>)| {
                let order = k + 1;
                // the last order of an even grid counts once
                let weight = if 2 * order == n { 1.0 } else { 2.0 };
                weight * (f * self.turn[order * i % n].conj()).re
            };
            coefficients.iter().enumerate().map(part).sum()
        };
        (0..n).map(value).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_has_its_amplitude_and_phase_and_comes_back() {
        let n = 720;
        let curve: Vec<f64> = (0..n)
            .map(|i| 4.0 + 3.0 * (TAU * 7.0 * f64::from(i) / f64::from(n) - 0.4).cos())
            .collect();
        let orders = Orders::new(720, 40);
        let spectrum = orders.transform(&curve);
        for (k, f) in spectrum.iter().enumerate() {
            if k + 1 == 7 {
                assert!((f.norm() - 1.5).abs() < 1e-12 && (f.arg() + 0.4).abs() < 1e-12);
            } else {
                assert!(f.norm() < 1e-12);
            }
        }
        for (back, value) in orders.curve(&spectrum).iter().zip(&curve) {
            assert!((back - (value - 4.0)).abs() < 1e-10);
        }
    }

    #[test]
    fn orders_beyond_the_grid_do_not_exist() {
        assert_eq!(Orders::new(24, 100).highest(), 12);
        let saw: Vec<f64> = (0..24)
            .map(|i| if i % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        let spectrum = Orders::new(24, 12).transform(&saw);
        assert!((spectrum[11].re - 1.0).abs() < 1e-12);
        let back = Orders::new(24, 12).curve(&spectrum);
        assert!(back.iter().zip(&saw).all(|(a, b)| (a - b).abs() < 1e-12));
    }
}
