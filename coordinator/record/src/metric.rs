//! Metric in which curves are fitted and tested: residuals in units of their own uncertainty.
//!
//! The entries of all channels of a group with the same index in their basis (an order of the period, a
//! sample) are divided by the Cholesky factor of their covariance. Errors of the measured input are
//! marginalised: with nuisance columns N of standard deviations T, `(I + N T^2 N^T)^(-1/2)` is applied on
//! top. Every entry of a residual that is noise alone then has variance 1.
use crate::basis::{ChannelGroup, smoothed};
use crate::bins::{Bins, along};
use crate::measured::Curves;
use crate::noise::{Noise, NoiseSource, widening};
use crate::spectrum::Spectra;
use nalgebra::{Complex, DMatrix, DVector};

type C = Complex<f64>;

/// Linear transform of a record's curves into units of their uncertainty (whitening).
#[derive(Clone, Debug)]
pub struct Metric {
    blocks: Vec<Block>,
    channels: usize,
    known: NoiseSource,
    /// Orthonormal directions of the marginalised errors in whitened space, and the share by which each is
    /// shortened.
    shrunk: Option<(DMatrix<f64>, DVector<f64>)>,
}

/// Range of a whitened vector that belongs to one group of channels, ordered by basis coefficient, channel,
/// real and imaginary part.
#[derive(Clone, Debug)]
struct Block {
    group: ChannelGroup,
    /// Inverse Cholesky factor of the noise covariance between the group's channels, by basis coefficient.
    factors: Vec<DMatrix<C>>,
    /// Degrees of freedom of the noise variances of the group, by basis coefficient.
    freedoms: Vec<f64>,
    /// Index in the whitened vector at which the group's range begins.
    begin: usize,
}

impl Block {
    fn rows(&self) -> usize {
        self.group.channels.len()
    }

    fn parts(&self) -> usize {
        self.group.basis.parts()
    }

    /// Returns the factor that gives real and imaginary part of a whitened coefficient variance 1: sqrt(2)
    /// for complex coefficients, else 1.
    fn scale(&self) -> f64 {
        if self.parts() == 2 {
            // a circular complex variable of variance 1 has parts of variance 1/2
            std::f64::consts::SQRT_2
        } else {
            1.0
        }
    }

    fn len(&self) -> usize {
        self.parts() * self.rows() * self.factors.len()
    }

    /// Returns the index in the whitened vector of basis coefficient `place` of the group's channel `row`.
    fn at(&self, place: usize, row: usize) -> usize {
        self.begin + self.parts() * (place * self.rows() + row)
    }

    /// Returns basis coefficient `place` of the group's channel `row` from a whitened vector, as a complex
    /// number.
    fn entry(&self, whitened: &DVector<f64>, place: usize, row: usize) -> C {
        let at = self.at(place, row);
        let imaginary = if self.parts() == 2 {
            whitened[at + 1]
        } else {
            0.0
        };
        Complex::new(whitened[at], imaginary)
    }

    /// Returns all basis coefficients of one channel from a whitened vector; `row` is the channel's index in
    /// the group.
    fn entries(&self, whitened: &DVector<f64>, row: usize) -> Vec<C> {
        let places = 0..self.factors.len();
        places
            .map(|place| self.entry(whitened, place, row))
            .collect()
    }

    fn whiten(&self, spectra: &Spectra, out: &mut DVector<f64>) {
        let scale = self.scale();
        let mut at = self.begin;
        for (k, factor) in self.factors.iter().enumerate() {
            for row in 0..self.rows() {
                let mut sum = Complex::new(0.0, 0.0);
                for (column, spectrum) in spectra.iter().enumerate().take(row + 1) {
                    sum += factor[(row, column)] * spectrum[k];
                }
                out[at] = scale * sum.re;
                if self.parts() == 2 {
                    out[at + 1] = scale * sum.im;
                }
                at += self.parts();
            }
        }
    }

    fn colour(&self, whitened: &DVector<f64>, out: &mut Spectra) {
        for (k, factor) in self.factors.iter().enumerate() {
            let part = DVector::from_fn(self.rows(), |row, _| {
                self.entry(whitened, k, row) / self.scale()
            });
            let solved = factor.solve_lower_triangular(&part).unwrap_or(part);
            for (c, f) in self.group.channels.iter().zip(solved.iter()) {
                out[*c].push(*f);
            }
        }
    }

    /// Returns the standard deviations of the basis coefficients of a channel's mean over the cycles.
    fn deviations(&self, row: usize) -> Vec<f64> {
        let deviation = |factor: &DMatrix<C>| {
            let lower = factor.clone().try_inverse();
            let square: f64 = lower.map_or(0.0, |l| l.row(row).iter().map(Complex::norm_sqr).sum());
            square.sqrt()
        };
        self.factors.iter().map(deviation).collect()
    }
}

impl Metric {
    /// Builds the metric from the Hermitian covariances of the mean's basis coefficients, for groups that
    /// together hold all channels of a record. A coefficient whose covariance is not positive definite is
    /// left out.
    pub fn new(groups: &[ChannelGroup], noise: &Noise) -> Self {
        let mut begin = 0;
        let block =
            |((group, covariances), freedoms): ((&ChannelGroup, &Vec<DMatrix<C>>), &Vec<f64>)| {
                let rows = group.channels.len();
                let factor = |covariance: &DMatrix<C>| {
                    let lower = covariance.clone().cholesky()?.unpack();
                    lower.solve_lower_triangular(&DMatrix::identity(rows, rows))
                };
                let factors = covariances.iter();
                let block = Block {
                    factors: factors
                        .map(|s| factor(s).unwrap_or_else(|| DMatrix::zeros(rows, rows)))
                        .collect(),
                    freedoms: freedoms.clone(),
                    group: group.clone(),
                    begin,
                };
                begin += block.len();
                block
            };
        Self {
            blocks: groups
                .iter()
                .zip(&noise.covariances)
                .zip(&noise.freedoms)
                .map(block)
                .collect(),
            known: noise.known,
            channels: groups.iter().map(|group| group.channels.len()).sum(),
            shrunk: None,
        }
    }

    /// Returns the source of the noise covariances: estimated from cycles, stated or guessed.
    pub const fn known(&self) -> NoiseSource {
        self.known
    }

    /// Returns the variance of each entry of a whitened vector of noise, given that the noise variances were
    /// estimated from few cycles: that of Student's distribution with their degrees of freedom, at most
    /// 1.5; 1 where they were not estimated.
    pub fn student_variances(&self) -> DVector<f64> {
        let mut out = DVector::from_element(self.len(), 1.0);
        for block in &self.blocks {
            let width = block.parts() * block.rows();
            for (place, freedom) in block.freedoms.iter().enumerate() {
                if freedom.is_finite() {
                    out.rows_mut(block.begin + width * place, width)
                        .fill(widening(0.5 * freedom, 1.0));
                }
            }
        }
        out
    }

    /// Returns the smallest number of degrees of freedom of a variance, slow curves left out; infinite where
    /// no variance was estimated from cycles.
    pub fn freedom(&self) -> f64 {
        let pooled = self.blocks.iter().flat_map(|block| {
            let slow = block
                .group
                .basis
                .slow()
                .min(block.freedoms.len().saturating_sub(1));
            &block.freedoms[slow..]
        });
        pooled.copied().fold(f64::INFINITY, f64::min)
    }

    /// Returns the degrees of freedom of the noise variance for confidence intervals: those of the least well
    /// known entry, slow curves left out. An order counts alone, without the neighbours it is pooled with,
    /// since these are only about as strong; innovations of samples count pooled.
    pub fn freedom_of_intervals(&self) -> f64 {
        let each = self.blocks.iter().flat_map(|block| {
            let basis = &block.group.basis;
            let slow = basis.slow().min(block.freedoms.len().saturating_sub(1));
            let places = block.freedoms.iter().enumerate().skip(slow);
            places.map(move |(place, freedom)| {
                if block.group.is_periodic() {
                    freedom / basis.neighbours(place).count() as f64
                } else {
                    *freedom
                }
            })
        });
        each.fold(f64::INFINITY, f64::min)
    }

    /// Returns the number of channels that the metric compares.
    pub const fn channels(&self) -> usize {
        self.channels
    }

    /// Returns the length of a whitened vector.
    pub fn len(&self) -> usize {
        self.blocks.iter().map(Block::len).sum()
    }

    /// Returns whether a whitened vector has no entries.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns whether all channels have a period, so that orders can be divided into low and high ones.
    pub fn is_periodic(&self) -> bool {
        self.blocks.iter().all(|block| block.group.is_periodic())
    }

    /// Returns curves in units of their uncertainty. The map is linear: the whitened residual of two curves
    /// is the difference of their images.
    pub fn whiten(&self, curves: &Curves) -> DVector<f64> {
        let mut out = DVector::zeros(self.len());
        for block in &self.blocks {
            block.whiten(&block.group.transform(curves), &mut out);
        }
        self.shorten(&mut out);
        out
    }

    /// Marginalises error directions, given as whitened curves times the standard deviation of the error.
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

    /// Returns the basis coefficients of a whitened vector by channel, in physical units: the inverse of the
    /// whitening, except that marginalised directions stay shortened.
    pub fn unwhiten(&self, whitened: &DVector<f64>) -> Spectra {
        let mut out = vec![Vec::new(); self.channels];
        for block in &self.blocks {
            block.colour(whitened, &mut out);
        }
        out
    }

    /// Returns the curves of which a whitened vector is the image, those of channels without an absolute zero up to a constant.
    pub fn curves(&self, whitened: &DVector<f64>) -> Curves {
        let entries = self.unwhiten(whitened);
        self.by_channel(|block, row| {
            let own = &entries[block.group.channels[row]];
            block.group.basis.curve(row, own)
        })
    }

    /// Returns the basis coefficients (orders or innovations) of curves, by channel, without whitening.
    pub fn entries(&self, curves: &Curves) -> Spectra {
        self.by_channel(|block, row| {
            let curve = &curves[block.group.channels[row]];
            block.group.basis.transform(row, curve)
        })
    }

    /// Returns the derivative of each curve by its abscissa.
    pub fn slopes(&self, curves: &Curves) -> Curves {
        self.by_channel(|block, row| block.group.slope(&curves[block.group.channels[row]]))
    }

    /// Returns the root mean square of the curve that each channel's basis coefficients describe, in the
    /// channel's unit.
    pub fn rms(&self, spectra: &Spectra) -> Vec<f64> {
        self.by_channel(|block, row| {
            block
                .group
                .basis
                .rms(row, &spectra[block.group.channels[row]])
        })
    }

    /// Returns the standard error of the record's mean, as root mean square along each channel, in its unit.
    pub fn standard_error(&self) -> Vec<f64> {
        self.by_channel(|block, row| block.group.basis.deviation(&block.deviations(row)))
    }

    /// Returns the waves of a whitened vector by channel, lowest first: orders of the period where a channel
    /// has one, else waves of its samples. Their real and imaginary parts have variance 1 under noise.
    pub fn waves(&self, whitened: &DVector<f64>) -> Spectra {
        self.by_channel(|block, row| block.group.basis.waves(row, block.entries(whitened, row)))
    }

    /// Returns a whitened vector as values along each channel's abscissa, one value per bin of
    /// [`Self::bins`].
    pub fn along(&self, whitened: &DVector<f64>) -> Vec<Vec<f64>> {
        self.by_channel(|block, row| along(&block.group, row, &block.entries(whitened, row)))
    }

    /// Returns the bins into which each channel's abscissa is divided.
    pub fn bins(&self) -> Vec<Bins> {
        self.by_channel(|block, _| Bins::of(&block.group))
    }

    /// Returns, for each element of a whitened vector, the mean power of its neighbouring basis coefficients,
    /// in noise variances.
    pub fn powers(&self, whitened: &DVector<f64>) -> DVector<f64> {
        let mut out = DVector::zeros(self.len());
        for block in &self.blocks {
            let parts = block.parts();
            for row in 0..block.rows() {
                let entries = block.entries(whitened, row);
                let powers: Vec<f64> = entries
                    .iter()
                    .map(|e| e.norm_sqr() / parts as f64)
                    .collect();
                for (place, power) in smoothed(&block.group.basis, &powers).iter().enumerate() {
                    let at = block.at(place, row);
                    out.rows_mut(at, parts).fill(*power);
                }
            }
        }
        out
    }

    /// Applies a function to every channel, given by its group and its index there; returns the results in
    /// the channel order of the record.
    fn by_channel<T>(&self, of: impl Fn(&Block, usize) -> T) -> Vec<T> {
        let of = &of;
        let each = self.blocks.iter().flat_map(|block| {
            let channels = block.group.channels.iter().enumerate();
            channels.map(move |(row, channel)| (*channel, of(block, row)))
        });
        let mut each: Vec<(usize, T)> = each.collect();
        each.sort_by_key(|(channel, _)| *channel);
        each.into_iter().map(|(_, own)| own).collect()
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
    use crate::basis::Basis;
    use crate::spectrum::Orders;
    use protocol::case::Abscissa;

    fn group() -> ChannelGroup {
        ChannelGroup {
            channels: vec![0, 1],
            abscissa: Abscissa {
                name: "phase".to_owned(),
                unit: "deg".to_owned(),
                points: (0..24).map(|i| 15.0 * f64::from(i)).collect(),
                period: Some(360.0),
            },
            basis: Basis::Orders(Orders::new(24, 3)),
        }
    }

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
        let noise = Noise {
            covariances: vec![(0..3).map(covariance).collect()],
            known: NoiseSource::Stated,
            freedoms: vec![vec![f64::INFINITY; 3]],
        };
        Metric::new(&[group()], &noise)
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
            let orders = Orders::new(24, 3);
            let f = DVector::from_fn(2, |c, _| orders.coefficient(&curves[c], k + 1));
            let solved = covariance.lu().solve(&f).unwrap();
            expected += 2.0 * f.dotc(&solved).re;
        }
        assert!((whitened.norm_squared() - expected).abs() < 1e-9 * expected);
        // coloured again, they are the curves' own entries
        for (back, own) in metric
            .unwhiten(&whitened)
            .iter()
            .zip(metric.entries(&curves))
        {
            assert!(back.iter().zip(&own).all(|(a, b)| (a - b).norm() < 1e-9));
        }
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
