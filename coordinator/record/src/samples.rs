//! Curves by sample: the innovation of each sample relative to the one before it.
//!
//! Noise with a correlation length `l` (an Ornstein-Uhlenbeck process, which is a first-order autoregression
//! on any grid) has the correlation `rho_i = exp(-(x_i+1 - x_i) / l)` between neighbours. Its innovations
//! `(y_i+1 - rho_i y_i) / sqrt(1 - rho_i^2)` are independent and as strong as the noise itself. Where a
//! channel has no fixed zero, Householder reflections turn a constant into one entry that is left out, so
//! that n samples give n - 1 entries. Where it has a fixed zero, the constant and the first order of the span
//! (for eight samples and more) become the first three entries: cycles that drift scatter more in these than
//! from sample to sample. Values with unequal weights are multiplied by their weights first.
use crate::measured::power;
use nalgebra::Complex;
use protocol::case::Channel;

type C = Complex<f64>;

/// Transform of curves on a grid of samples into innovations, for one correlation length of the noise.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Correlation of each sample with the one before it; 0 for the first.
    rho: Vec<f64>,
    /// Householder vectors of the reflections that turn slow curves into the first coefficients: the constant
    /// and, if constants count, the first order of the span.
    householder_vectors: Vec<Vec<f64>>,
    /// Norm of the part of each slow curve that is orthogonal to the ones before it.
    lengths: Vec<f64>,
    /// Whether the constant of a curve counts (channel with a fixed zero).
    absolute: bool,
    /// Weights of the values; empty where all weights are equal.
    weights: Vec<f64>,
}

/// Least number of samples from which the first order of the span can be told from the noise.
const ORDER_SHOWS: usize = 8;

impl Samples {
    /// Creates the transform for a channel's grid of samples and a correlation length of the noise, in the
    /// abscissa's unit; 0 for independent samples.
    pub fn of(channel: &Channel, length: f64) -> Self {
        let points = &channel.abscissa.points;
        Self::new(points, &channel.weights, channel.is_absolute(), length)
    }

    /// Creates the transform for an ascending grid of samples, with at least two samples if constants do not
    /// count.
    fn new(points: &[f64], weights: &[f64], absolute: bool, length: f64) -> Self {
        let gaps = points.windows(2).map(|pair| pair[1] - pair[0]);
        let rho = gaps.map(|gap| {
            if length > 0.0 {
                libm::exp(-gap / length)
            } else {
                0.0
            }
        });
        let mut samples = Self {
            rho: std::iter::once(0.0).chain(rho).collect(),
            householder_vectors: Vec::new(),
            lengths: Vec::new(),
            absolute,
            weights: weights.to_vec(),
        };
        for slow in slow_curves(points, absolute) {
            let mut mirror = samples.reflected(samples.innovations(&slow));
            let known = samples.householder_vectors.len();
            mirror[..known].fill(0.0);
            let norm = length_of(&mirror);
            if norm <= f64::EPSILON * points.len() as f64 {
                break;
            }
            // away from the entry's own sign: no cancellation
            mirror[known] += norm.copysign(mirror[known]);
            let length = length_of(&mirror);
            samples
                .householder_vectors
                .push(mirror.iter().map(|v| v / length).collect());
            samples.lengths.push(norm);
        }
        samples
    }

    /// Creates the transform with the correlation length of greatest restricted likelihood for the noise of
    /// several curves about their common mean; their constants are not constrained.
    pub fn likeliest(channel: &Channel, deviations: &[Vec<f64>]) -> Self {
        /// Number of positive correlation lengths that are tried, up to the whole grid.
        const TRIED: u32 = 60;
        let points = &channel.abscissa.points;
        let (Some(first), Some(last), 4..) = (points.first(), points.last(), points.len()) else {
            // so few tell no length
            return Self::of(channel, 0.0);
        };
        let shortest = 0.2 * (last - first) / points.len() as f64;
        let ratio = libm::log((last - first) / shortest) / f64::from(TRIED);
        let tried = (0..=TRIED).map(|k| {
            let length = if k == 0 {
                0.0
            } else {
                shortest * libm::exp(ratio * f64::from(k))
            };
            Self::of(channel, length)
        });
        let surprise = tried.map(|samples| (samples.negative_log_likelihood(deviations), samples));
        let least = surprise.min_by(|(a, _), (b, _)| a.total_cmp(b));
        least.map_or_else(|| Self::of(channel, 0.0), |(_, samples)| samples)
    }

    /// Returns the number of transformed coefficients of a curve.
    pub fn len(&self) -> usize {
        self.rho.len().saturating_sub(self.left_out())
    }

    /// Returns whether the constant of a curve counts as disagreement.
    pub const fn is_absolute(&self) -> bool {
        self.absolute
    }

    /// Returns the number of leading coefficients that are slow curves (constant, first order of the span)
    /// instead of innovations.
    pub const fn slow(&self) -> usize {
        if self.absolute {
            self.householder_vectors.len()
        } else {
            0
        }
    }

    /// Returns the number of leading reflected innovations that are dropped because the constant does not
    /// count.
    const fn left_out(&self) -> usize {
        if self.absolute {
            0
        } else {
            self.householder_vectors.len()
        }
    }

    /// Returns coefficients sample by sample: those of slow curves are transformed back to values at each
    /// sample.
    pub fn by_sample(&self, entries: &[C]) -> Vec<f64> {
        let row: Vec<f64> = entries.iter().map(|e| e.re).collect();
        if self.absolute {
            self.turned_back(row)
        } else {
            row
        }
    }

    /// Returns whether a transformed curve has no coefficients.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the transformed coefficients of a curve; their imaginary part is zero.
    pub fn transform(&self, curve: &[f64]) -> Vec<C> {
        let turned = self.reflected(self.innovations(curve)).into_iter();
        turned.skip(self.left_out()).map(C::from).collect()
    }

    /// Returns the curve with the given transformed coefficients, up to a constant if constants do not count.
    pub fn curve(&self, entries: &[C]) -> Vec<f64> {
        let left_out = std::iter::repeat_n(0.0, self.left_out());
        let all = left_out.chain(entries.iter().map(|e| e.re));
        let mut before = 0.0;
        let step = |(rho, e): (&f64, f64)| {
            before = rho * before + (1.0 - rho * rho).sqrt() * e;
            before
        };
        let all = self.turned_back(all.collect());
        let mut curve: Vec<f64> = self.rho.iter().zip(all).map(step).collect();
        for (y, weight) in curve.iter_mut().zip(&self.weights) {
            *y /= weight;
        }
        curve
    }

    /// Returns the root mean square of the curve with the given transformed coefficients, about its mean if
    /// constants do not count.
    pub fn rms(&self, entries: &[C]) -> f64 {
        power(&self.curve(entries), self.is_absolute()).sqrt()
    }

    fn innovations(&self, curve: &[f64]) -> Vec<f64> {
        let mut before = 0.0;
        let step = |(i, (rho, y)): (usize, (&f64, &f64))| {
            let y = self.weights.get(i).map_or(*y, |weight| weight * y);
            let innovation = (y - rho * before) / (1.0 - rho * rho).sqrt();
            before = y;
            innovation
        };
        self.rho.iter().zip(curve).enumerate().map(step).collect()
    }

    fn reflected(&self, x: Vec<f64>) -> Vec<f64> {
        self.householder_vectors
            .iter()
            .fold(x, |x, mirror| reflected(x, mirror))
    }

    fn turned_back(&self, x: Vec<f64>) -> Vec<f64> {
        self.householder_vectors
            .iter()
            .rev()
            .fold(x, |x, mirror| reflected(x, mirror))
    }

    /// Returns minus twice the log restricted likelihood of this correlation length, with slow curves left
    /// free and at the most likely variance, up to a constant of the curves.
    fn negative_log_likelihood(&self, deviations: &[Vec<f64>]) -> f64 {
        let square = |curve: &Vec<f64>| {
            let entries = self.transform(curve).into_iter().skip(self.slow());
            entries.map(|e| e.norm_sqr()).sum::<f64>()
        };
        let sum: f64 = deviations.iter().map(square).sum();
        let slow: f64 = self.lengths.iter().map(|own| libm::log(*own)).sum();
        let determinant: f64 = self.rho.iter().map(|rho| libm::log(1.0 - rho * rho)).sum();
        (self.len() - self.slow()) as f64 * libm::log(sum.max(f64::MIN_POSITIVE))
            + determinant
            + 2.0 * slow
    }
}

/// Returns the slow curves that have coefficients of their own: the constant and, if constants count, both
/// phases of the first order of the span. A single value with a fixed zero has none.
fn slow_curves(points: &[f64], absolute: bool) -> Vec<Vec<f64>> {
    let n = points.len();
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Vec::new();
    };
    if absolute && n == 1 {
        return Vec::new();
    }
    let constant = vec![1.0; n];
    if !absolute || n < ORDER_SHOWS {
        return vec![constant];
    }
    let turn = std::f64::consts::TAU * (n as f64 - 1.0) / (n as f64 * (last - first));
    let angles = || points.iter().map(|x| turn * (x - first));
    vec![
        constant,
        angles().map(libm::cos).collect(),
        angles().map(libm::sin).collect(),
    ]
}

fn reflected(mut x: Vec<f64>, mirror: &[f64]) -> Vec<f64> {
    let along: f64 = x.iter().zip(mirror).map(|(x, v)| x * v).sum();
    for (x, v) in x.iter_mut().zip(mirror) {
        *x -= 2.0 * along * v;
    }
    x
}

fn length_of(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::recorded;
    use protocol::case::{Abscissa, Offset};
    use search::random::{Phase, Streams};

    fn channel(points: &[f64], weights: &[f64], absolute: bool) -> Channel {
        Channel {
            abscissa: Abscissa {
                name: "time".to_owned(),
                unit: "s".to_owned(),
                points: points.to_vec(),
                period: None,
            },
            weights: weights.to_vec(),
            offset: if absolute {
                Offset::Fixed
            } else {
                Offset::Free
            },
            ..recorded(0).channel
        }
    }

    fn uneven(n: usize) -> Vec<f64> {
        let step = |k: usize| 0.01 * (1.0 + 0.5 * (k as f64).sin());
        (0..n)
            .scan(2.0, |x, k| {
                *x += step(k);
                Some(*x)
            })
            .collect()
    }

    /// Returns noise of a correlation length on a grid, plus a constant.
    fn coloured(points: &[f64], length: f64, seed: u64, size: f64) -> Vec<f64> {
        let mut stream = Streams::new(seed, 11).at(0, Phase::Initial, 0);
        let mut y = stream.normal();
        let mut before = points[0];
        let next = |x: &f64| {
            let rho = (-(x - before) / length).exp();
            before = *x;
            y = rho * y + (1.0 - rho * rho).sqrt() * stream.normal();
            7.0 + size * y
        };
        points.iter().map(next).collect()
    }

    #[test]
    fn a_constant_has_no_entry_and_every_other_curve_comes_back() {
        let points = uneven(50);
        let samples = Samples::of(&channel(&points, &[], false), 0.03);
        assert!(
            samples
                .transform(&[4.0; 50])
                .iter()
                .all(|e| e.norm() < 1e-12)
        );
        let curve: Vec<f64> = (0..50).map(|i| f64::from(i * i % 17)).collect();
        let back = samples.curve(&samples.transform(&curve));
        let shift = curve[0] - back[0];
        assert!(
            back.iter()
                .zip(&curve)
                .all(|(b, y)| (b + shift - y).abs() < 1e-9)
        );
    }

    /// Checks that, where the constant counts, every curve is recovered with and without weights, and that a
    /// single value has one entry.
    #[test]
    fn a_constant_counts_where_a_channel_has_a_zero() {
        let points = uneven(20);
        let weights: Vec<f64> = (0..20).map(|i| 1.0 + f64::from(i % 3)).collect();
        for weights in [&[][..], &weights] {
            let samples = Samples::of(&channel(&points, weights, true), 0.02);
            let curve: Vec<f64> = (0..20).map(|i| 5.0 + f64::from(i * i % 7)).collect();
            let entries = samples.transform(&curve);
            assert_eq!(entries.len(), 20);
            let back = samples.curve(&entries);
            assert!(back.iter().zip(&curve).all(|(b, y)| (b - y).abs() < 1e-9));
        }
        let one = Samples::of(&channel(&[3.0], &[4.0], true), 0.0);
        assert_eq!(one.transform(&[2.5]), [C::from(10.0)]);
    }

    /// Checks that the entries of coloured noise are uncorrelated from one to the next and as strong as in
    /// the few cycles from which the correlation length was estimated.
    #[test]
    fn entries_of_coloured_noise_are_white() {
        let points = uneven(400);
        for length in [0.02, 0.1] {
            let cycles: Vec<Vec<f64>> = (0..4)
                .map(|seed| coloured(&points, length, seed, 3.0))
                .collect();
            let mean = |i: usize| cycles.iter().map(|cycle| cycle[i]).sum::<f64>() / 4.0;
            let less =
                |cycle: &Vec<f64>| cycle.iter().enumerate().map(|(i, y)| y - mean(i)).collect();
            let deviations: Vec<Vec<f64>> = cycles.iter().map(less).collect();
            let samples = Samples::likeliest(&channel(&points, &[], false), &deviations);
            let power = |curve: &Vec<f64>| -> f64 {
                samples.transform(curve).iter().map(C::norm_sqr).sum()
            };
            // four cycles lie about their own mean with three degrees of freedom
            let seen = deviations.iter().map(power).sum::<f64>() / 3.0;
            let (mut square, mut lagged) = (0.0, 0.0);
            for seed in 100..130 {
                let noise = coloured(&points, length, seed, 3.0);
                let e = samples.transform(&noise);
                square += power(&noise);
                lagged += e
                    .windows(2)
                    .map(|pair| pair[0].re * pair[1].re)
                    .sum::<f64>();
            }
            let (ratio, correlation) = (square / 30.0 / seen, lagged / square);
            assert!((ratio - 1.0).abs() < 0.1, "{length} {ratio}");
            assert!(correlation.abs() < 0.08, "{length} {correlation}");
        }
    }

    #[test]
    fn white_noise_is_told_from_coloured() {
        let points = uneven(300);
        let cycles: Vec<Vec<f64>> = (0..3)
            .map(|seed| coloured(&points, 1e-4, seed, 1.0))
            .collect();
        let samples = Samples::likeliest(&channel(&points, &[], false), &cycles);
        assert!(samples.rho.iter().all(|rho| *rho < 0.2));
    }
}
