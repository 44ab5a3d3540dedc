//! The metric in which everything is fitted and tested: residuals in units of their own
//! uncertainty.
//!
//! The coefficients of all channels at one order of the crank are divided by the Cholesky factor of
//! their covariance; what the measured input may be wrong by (load scale, crank angle) is
//! marginalised: with nuisance columns N of standard deviations T, `(I + N T^2 N^T)^(-1/2)` is
//! applied on top. Every entry of a residual that is noise alone then has variance 1.
use crate::record::measured::Curves;
use crate::record::spectrum::Orders;
use nalgebra::{Complex, DMatrix, DVector};

/// Whitening of curves.
#[derive(Clone, Debug)]
pub struct Metric {
    orders: Orders,
    channels: usize,
    /// Inverse Cholesky factors, order by order.
    factors: Vec<DMatrix<Complex<f64>>>,
    /// Orthonormal directions and by how much each is shortened.
    shrunk: Option<(DMatrix<f64>, DVector<f64>)>,
}

impl Metric {
    /// From the covariance of the mean coefficients at each order; `channels` x `channels`,
    /// Hermitian. A covariance that is not positive definite leaves its order out.
    pub fn new(orders: Orders, channels: usize, covariances: &[DMatrix<Complex<f64>>]) -> Self {
        let nothing = || DMatrix::zeros(channels, channels);
        let factor = |covariance: &DMatrix<Complex<f64>>| {
            let lower = covariance.clone().cholesky()?.unpack();
            lower.solve_lower_triangular(&DMatrix::identity(channels, channels))
        };
        Self {
            factors: covariances
                .iter()
                .map(|s| factor(s).unwrap_or_else(nothing))
                .collect(),
            orders,
            channels,
            shrunk: None,
        }
    }

    /// Orders and channels.
    pub const fn orders(&self) -> &Orders {
        &self.orders
    }

    /// Number of channels.
    pub const fn channels(&self) -> usize {
        self.channels
    }

    /// Length of a whitened vector: order, channel, real and imaginary part.
    pub fn len(&self) -> usize {
        2 * self.channels * self.factors.len()
    }

    /// Whether there is nothing to compare.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Order (from 1) and channel of an entry of a whitened vector.
    pub const fn place(&self, entry: usize) -> (usize, usize) {
        (1 + entry / (2 * self.channels), entry / 2 % self.channels)
    }

    /// The whitened coefficient of an order (from 1) and a channel.
    pub fn coefficient(
        &self,
        whitened: &DVector<f64>,
        order: usize,
        channel: usize,
    ) -> Complex<f64> {
        let at = self.entry(order, channel);
        Complex::new(whitened[at], whitened[at + 1])
    }

    /// Where that coefficient begins in a whitened vector.
    pub const fn entry(&self, order: usize, channel: usize) -> usize {
        2 * ((order - 1) * self.channels + channel)
    }

    /// Curves in units of their uncertainty. Linear: the residual of two curves is the difference of
    /// their images.
    pub fn whiten(&self, curves: &Curves) -> DVector<f64> {
        let spectra: Vec<Vec<Complex<f64>>> = curves
            .iter()
            .map(|curve| self.orders.transform(curve))
            .collect();
        self.whiten_spectra(&spectra)
    }

    /// The same from the coefficients, channel by channel.
    pub fn whiten_spectra(&self, spectra: &[Vec<Complex<f64>>]) -> DVector<f64> {
        let mut out = DVector::zeros(self.len());
        let mut at = 0;
        for (k, factor) in self.factors.iter().enumerate() {
            for row in 0..self.channels {
                let mut sum = Complex::new(0.0, 0.0);
                for (column, spectrum) in spectra.iter().enumerate().take(row + 1) {
                    sum += factor[(row, column)] * spectrum[k];
                }
                // a circular complex variable of variance 1 has parts of variance 1/2
                out[at] = std::f64::consts::SQRT_2 * sum.re;
                out[at + 1] = std::f64::consts::SQRT_2 * sum.im;
                at += 2;
            }
        }
        self.shorten(&mut out);
        out
    }

    /// Marginalises directions, given as images under this metric times their standard deviation.
    pub fn marginalize(&mut self, directions: &[DVector<f64>]) {
        if directions.is_empty() {
            return;
        }
        let svd = DMatrix::from_columns(directions).svd(true, false);
        let Some(u) = svd.u else { return };
        let lost = svd
            .singular_values
            .map(|s| 1.0 - 1.0 / (1.0 + s * s).sqrt());
        self.shrunk = Some((u, lost));
    }

    /// Coefficients whose image a whitened vector is, by channel; what was marginalised stays
    /// shortened.
    pub fn colour(&self, whitened: &DVector<f64>) -> Vec<Vec<Complex<f64>>> {
        let channels = self.channels();
        let mut out = vec![Vec::with_capacity(self.orders().highest()); channels];
        for (k, factor) in self.factors.iter().enumerate() {
            let part = DVector::from_fn(channels, |c, _| {
                self.coefficient(whitened, k + 1, c) / std::f64::consts::SQRT_2
            });
            let solved = factor.solve_lower_triangular(&part).unwrap_or(part);
            for (curve, f) in out.iter_mut().zip(solved.iter()) {
                curve.push(*f);
            }
        }
        out
    }

    /// Standard deviation of every channel's mean coefficient, by channel and order.
    pub fn deviations(&self) -> Vec<Vec<f64>> {
        let channels = self.channels();
        let mut out = vec![Vec::new(); channels];
        for factor in &self.factors {
            let lower = factor.clone().try_inverse();
            for (c, row) in out.iter_mut().enumerate() {
                let square = lower
                    .as_ref()
                    .map_or(0.0, |l| l.row(c).iter().map(Complex::norm_sqr).sum());
                row.push(square.sqrt());
            }
        }
        out
    }

    fn shorten(&self, x: &mut DVector<f64>) {
        if let Some((u, lost)) = &self.shrunk {
            let parts = u.tr_mul(x).component_mul(lost);
            *x -= u * parts;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn metric() -> Metric {
        let covariance = |k: usize| {
            let s = 1.0 + k as f64;
            DMatrix::from_row_slice(
                2,
                2,
                &[
                    Complex::new(4.0 * s, 0.0),
                    Complex::new(1.0, 0.5),
                    Complex::new(1.0, -0.5),
                    Complex::new(2.0, 0.0),
                ],
            )
        };
        let covariances: Vec<_> = (0..3).map(covariance).collect();
        Metric::new(Orders::new(24, 3), 2, &covariances)
    }

    #[test]
    fn whitened_length_is_the_mahalanobis_length() {
        let curves: Curves = (0..2)
            .map(|c| {
                (0..24)
                    .map(|i| f64::from((i * i + 3 * c * i) % 11))
                    .collect()
            })
            .collect();
        let metric = metric();
        let whitened = metric.whiten(&curves);
        let mut expected = 0.0;
        for k in 0..3_usize {
            let s = 1.0 + k as f64;
            let covariance = DMatrix::from_row_slice(
                2,
                2,
                &[
                    Complex::new(4.0 * s, 0.0),
                    Complex::new(1.0, 0.5),
                    Complex::new(1.0, -0.5),
                    Complex::new(2.0, 0.0),
                ],
            );
            let f = DVector::from_fn(2, |c, _| metric.orders().coefficient(&curves[c], k + 1));
            let solved = covariance.lu().solve(&f).unwrap();
            expected += 2.0 * f.dotc(&solved).re;
        }
        assert!((whitened.norm_squared() - expected).abs() < 1e-9 * expected);
        assert_eq!(metric.place(0), (1, 0));
        assert_eq!(metric.place(7), (2, 1));
    }

    #[test]
    fn a_marginalised_direction_counts_as_its_uncertainty_allows() {
        let mut metric = metric();
        let curve: Curves = vec![
            (0..24)
                .map(|i| (std::f64::consts::TAU * f64::from(i) / 24.0).cos())
                .collect(),
            vec![0.0; 24],
        ];
        let image = metric.whiten(&curve);
        // an uncertainty of 3 times this curve
        metric.marginalize(&[&image * 3.0]);
        let left = metric.whiten(&curve).norm();
        let s = 3.0 * image.norm();
        assert!((left - image.norm() / (1.0 + s * s).sqrt()).abs() < 1e-12);
    }
}
