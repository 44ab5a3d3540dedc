//! Fourier transform between curves over a turn and their spectra.
use super::amounts::{C, HIGHEST};
use crate::case::SAMPLES;
use std::f64::consts::TAU;

/// Table of the phasors at the grid's crank angles, for Fourier transforms.
pub(super) struct FourierTable(pub(super) Vec<C>);

impl FourierTable {
    pub(super) fn new() -> Self {
        let unit = |i: usize| C::from_polar(1.0, TAU * i as f64 / SAMPLES as f64);
        Self((0..SAMPLES).map(unit).collect())
    }

    /// Returns the Fourier coefficients of a curve, from order 0 to the highest order.
    pub(super) fn transform(&self, curve: &[f64]) -> Vec<C> {
        let coefficient = |h: usize| {
            let mut sum = C::new(0.0, 0.0);
            let mut at = 0;
            for y in curve {
                sum += self.0[at].conj() * *y;
                at += h;
                if at >= SAMPLES {
                    at -= SAMPLES;
                }
            }
            sum / SAMPLES as f64
        };
        (0..=HIGHEST).map(coefficient).collect()
    }

    /// Evaluates a spectrum at arbitrary angles (rad).
    pub(super) fn at(spectrum: &[C], angles: &[f64]) -> Vec<f64> {
        let value = |angle: &f64| {
            let unit = C::from_polar(1.0, *angle);
            let mut turned = unit;
            let mut sum = 0.5 * spectrum[0].re;
            for f in &spectrum[1..] {
                sum += (f * turned).re;
                turned *= unit;
            }
            2.0 * sum
        };
        angles.iter().map(value).collect()
    }

    pub(super) fn curve(&self, spectrum: &[C]) -> Vec<f64> {
        (0..SAMPLES)
            .map(|i| {
                let mut sum = 0.5 * spectrum[0].re;
                let mut at = i;
                for f in &spectrum[1..] {
                    let u = self.0[at];
                    sum += f.re * u.re - f.im * u.im;
                    at += i;
                    if at >= SAMPLES {
                        at -= SAMPLES;
                    }
                }
                2.0 * sum
            })
            .collect()
    }
}
