//! Smooth discrepancy between model and machine, as linear variables beside the unknowns of a fit.
//!
//! A model that is a little wrong leaves a smooth residual in every channel. It is described by a Gaussian
//! process over the abscissa, `delta = B c` with waves `B` (whitened curves) and coefficients `c ~ N(0, S)`,
//! where `S` gives a wave of `k` cycles per span a share `exp(-(2 pi k l)^2 / 2)` of the channel's variance:
//! the spectrum of a squared-exponential covariance of length `l`. The whitened residual `r` of a fit then has
//! the covariance `C = I + B S B^T`, and with the unknowns integrated out
//!
//! `ln Z = -1/2 (r^T C^-1 r + u^T u - g^T A^-1 g - ln |L| + ln |A| + ln |C|)`, `A = J^T C^-1 J + L`, `g = J^T C^-1 r + L (x - m)`
//!
//! up to a constant of the record, with the Jacobian `J` of the residual, priors of mean `m` and precision
//! `L`, and `u` the unknowns in units of their priors. `C` is never formed: with `D = B S^1/2`, `C^-1 = I - D (I + D^T D)^-1 D^T` and `|C| = |I + D^T D|`.
//! The standard deviation of each channel and the length maximise `ln Z` (type-II maximum likelihood: Rasmussen
//! & Williams, *Gaussian Processes for Machine Learning*, 5.4.1), for each model: a name competes
//! with "no effect, but a smooth discrepancy".
use crate::linear::evidence::{deviation, log_determinant};
use crate::linear::tangent::free;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use search::least_squares::{Linearized, Variable};
use std::f64::consts::TAU;

/// Lengths that are compared, as shares of the abscissa's span, and between which they are refined: one sixth leaves
/// waves of one and two cycles, one fiftieth all twelve that [`waves`](crate::linear::waves) has.
const LENGTHS: [f64; 4] = [1.0 / 6.0, 1.0 / 12.0, 1.0 / 25.0, 1.0 / 50.0];
/// Smallest standard deviation of a discrepancy that is compared, in standard errors of the record's mean:
/// less shows in no record.
const LEAST: f64 = 0.25;
/// Largest standard deviation that is compared, in those of the residual if it were all in one channel. Recalibration
/// takes most of a long wave, so that one of any size would explain what it leaves.
const LARGEST: f64 = 3.0;
/// Number of doublings of [`LEAST`] that are compared.
const DOUBLINGS: i32 = 12;
/// Factors by which the standard deviation of each channel and the length are changed one by one from the best of the
/// grid, which alone may be several nats below the maximum.
const REFINED: [f64; 4] = [4.0, 2.0, 1.4, 1.2];
/// Largest number of passes with one factor, and the gain (nats) of a pass from which on another one is worth it.
const PASSES: usize = 3;
const SETTLED: f64 = 0.3;

/// Wave of a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Wave {
    /// Index of the channel.
    pub channel: usize,
    /// Number of cycles over the span of the channel's abscissa.
    pub cycles: f64,
    /// Values along the abscissa.
    pub curve: Vec<f64>,
}

impl Wave {
    /// Returns the mean square of the wave over the abscissa.
    fn power(&self) -> f64 {
        self.curve.iter().map(|y| y * y).sum::<f64>() / self.curve.len().max(1) as f64
    }
}

/// Waves of which a discrepancy is made, in the metric of a record.
#[derive(Clone, Debug, Default)]
pub struct SmoothBasis {
    columns: DMatrix<f64>,
    waves: Vec<Wave>,
    /// Mean square of each wave over the abscissa.
    powers: Vec<f64>,
    /// `columns^T columns`.
    gram: DMatrix<f64>,
    /// Standard error of the record's mean, by channel.
    scales: Vec<f64>,
}

/// Standard deviations and length of a smooth discrepancy.
#[derive(Clone, Debug, PartialEq)]
pub struct Discrepancy {
    /// Standard deviation by channel, in the channel's unit.
    pub deviations: Vec<f64>,
    /// Correlation length, as a share of the abscissa's span.
    pub length: f64,
}

impl SmoothBasis {
    /// Collects whitened waves, one column each, of channels whose mean has the standard errors `scales`.
    pub fn new(columns: DMatrix<f64>, waves: Vec<Wave>, scales: Vec<f64>) -> Self {
        Self {
            gram: columns.tr_mul(&columns),
            columns,
            powers: waves.iter().map(Wave::power).collect(),
            waves,
            scales,
        }
    }

    /// Returns the standard error of the record's mean, by channel.
    pub fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// Returns the median over the channels of a discrepancy's standard deviation, in standard errors of the mean.
    pub fn strength(&self, discrepancy: &Discrepancy) -> f64 {
        let each = discrepancy.deviations.iter().zip(&self.scales);
        let mut ratios: Vec<f64> = each.map(|(own, scale)| own / scale).collect();
        ratios.sort_by(f64::total_cmp);
        ratios.get(ratios.len() / 2).copied().unwrap_or(0.0)
    }

    /// Returns the standard deviation of each wave's coefficient under a discrepancy.
    fn coefficients(&self, discrepancy: &Discrepancy) -> DVector<f64> {
        let share = |wave: &Wave| {
            let turns = TAU * wave.cycles * discrepancy.length;
            libm::exp(-0.5 * turns * turns)
        };
        let mut whole = vec![0.0; discrepancy.deviations.len()];
        for (wave, power) in self.waves.iter().zip(&self.powers) {
            if let Some(whole) = whole.get_mut(wave.channel) {
                *whole += share(wave) * power;
            }
        }
        let each = self.waves.iter().map(|wave| {
            let own = discrepancy.deviations.get(wave.channel).copied();
            let whole = whole.get(wave.channel).copied().unwrap_or(0.0);
            own.unwrap_or(0.0) * (share(wave) / whole.max(f64::MIN_POSITIVE)).sqrt()
        });
        DVector::from_iterator(self.waves.len(), each)
    }

    /// Returns the whitened waves, each times the standard deviation of its coefficient; waves that have none
    /// are left out.
    pub fn scaled(&self, discrepancy: &Discrepancy) -> DMatrix<f64> {
        let there = self.there(discrepancy);
        let places: Vec<usize> = there.iter().map(|(k, _)| *k).collect();
        let mut columns = self.columns.select_columns(&places);
        for (mut column, (_, deviation)) in columns.column_iter_mut().zip(there) {
            column *= deviation;
        }
        columns
    }

    /// Returns the waves that [`Self::scaled`] whitens, along the abscissa and in the channel's unit, each with the
    /// index of its channel.
    pub fn curves(&self, discrepancy: &Discrepancy) -> Vec<(usize, DVector<f64>)> {
        let there = self.there(discrepancy).into_iter();
        let curve = |(k, deviation): (usize, f64)| {
            let wave = &self.waves[k];
            (
                wave.channel,
                DVector::from_column_slice(&wave.curve) * deviation,
            )
        };
        there.map(curve).collect()
    }

    /// Returns the indices of the waves that a discrepancy has, with the standard deviations of their coefficients.
    fn there(&self, discrepancy: &Discrepancy) -> Vec<(usize, f64)> {
        let deviations = self.coefficients(discrepancy);
        let all = deviations.iter().copied().enumerate();
        all.filter(|(_, deviation)| *deviation > 0.0).collect()
    }

    /// Returns the log evidence that a fit gains by a discrepancy over none (nats); `None` where its information
    /// is singular.
    pub fn gain(
        &self,
        at: &Linearized,
        variables: &[Variable],
        discrepancy: &Discrepancy,
    ) -> Option<f64> {
        let problem = Problem::new(self, at, variables);
        let without = problem.log_evidence(&DVector::zeros(self.waves.len()))?;
        Some(problem.log_evidence(&self.coefficients(discrepancy))? - without)
    }

    /// Returns the discrepancy with which a fit is likeliest, and the log evidence that it gains over none
    /// (nats); `None` where none is likeliest.
    pub fn likeliest(&self, at: &Linearized, variables: &[Variable]) -> Option<(Discrepancy, f64)> {
        let problem = Problem::new(self, at, variables);
        let without = problem.log_evidence(&DVector::zeros(self.waves.len()))?;
        let count = at.residual.len().max(1) as f64;
        let share = at.residual.norm_squared() * self.scales.len() as f64 / count;
        let largest = LARGEST * share.max(1.0).sqrt();
        let value = |own: &Discrepancy| {
            let mut each = own.deviations.iter().zip(&self.scales);
            let large = each.any(|(own, scale)| *own > largest * scale);
            if large || !(LENGTHS[3]..=LENGTHS[0]).contains(&own.length) {
                return f64::NEG_INFINITY;
            }
            let value = problem.log_evidence(&self.coefficients(own));
            value.map_or(f64::NEG_INFINITY, |value| value - without)
        };
        let common = |power: i32, length: f64| {
            let factor = LEAST * 2_f64.powi(power);
            Discrepancy {
                deviations: self.scales.iter().map(|scale| factor * scale).collect(),
                length,
            }
        };
        let mut best: Option<(Discrepancy, f64)> = None;
        for length in LENGTHS {
            let mut highest = f64::NEG_INFINITY;
            let mut worse = 0;
            for power in 0..DOUBLINGS {
                let own = common(power, length);
                let gain = value(&own);
                worse = if gain > highest { 0 } else { worse + 1 };
                highest = highest.max(gain);
                if gain > best.as_ref().map_or(0.0, |(_, gain)| *gain) {
                    best = Some((own, gain));
                }
                // one maximum: two steps beyond it are enough
                if worse == 2 {
                    break;
                }
            }
        }
        let (mut own, mut gain) = best?;
        for step in REFINED {
            for _ in 0..PASSES {
                let before = gain;
                for k in 0..=self.scales.len() {
                    for factor in [step, 1.0 / step] {
                        let mut other = own.clone();
                        let changed = other.deviations.get_mut(k);
                        *changed.unwrap_or(&mut other.length) *= factor;
                        let value = value(&other);
                        if value > gain {
                            (own, gain) = (other, value);
                        }
                    }
                }
                if gain - before < SETTLED {
                    break;
                }
            }
        }
        Some((own, gain))
    }
}

/// Fit in the form in which its evidence is computed for many discrepancies: products of residual, Jacobian and
/// waves.
struct Problem<'a> {
    basis: &'a SmoothBasis,
    /// Products of the columns of `[J, r]`.
    gram: DMatrix<f64>,
    /// Products of the waves with the columns of `[J, r]`.
    mixed: DMatrix<f64>,
    /// Prior precision of each free variable.
    precision: DVector<f64>,
    /// Pull of the priors, `L (x - m)`.
    pull: DVector<f64>,
}

impl<'a> Problem<'a> {
    fn new(basis: &'a SmoothBasis, at: &Linearized, variables: &[Variable]) -> Self {
        let free = free(at, variables);
        let p = free.len();
        let mut columns = at.jacobian.select_columns(&free).insert_column(p, 0.0);
        columns.set_column(p, &at.residual);
        let precision = free.iter().map(|&k| {
            let deviation = deviation(&variables[k]);
            1.0 / (deviation * deviation)
        });
        let precision = DVector::from_iterator(p, precision);
        let off = free.iter().map(|&k| {
            let mean = variables[k].prior.map(|prior| prior.mean);
            mean.map_or(0.0, |mean| at.x[k] - mean)
        });
        Self {
            gram: columns.tr_mul(&columns),
            mixed: basis.columns.tr_mul(&columns),
            pull: precision.component_mul(&DVector::from_iterator(p, off)),
            precision,
            basis,
        }
    }

    /// Returns the log evidence with coefficients of the given standard deviations, up to a constant of the
    /// record; `None` where the information is singular.
    fn log_evidence(&self, deviations: &DVector<f64>) -> Option<f64> {
        /// Length of a whitened wave, in standard deviations of noise, below which it counts as absent.
        const FAINT: f64 = 1e-3;
        let p = self.precision.len();
        let mut gram = self.gram.clone();
        let loud = |k: &usize| {
            let own = self.basis.gram[(*k, *k)].sqrt() * deviations[*k];
            own > FAINT
        };
        let there: Vec<usize> = (0..deviations.len()).filter(loud).collect();
        let mut volume = 0.0;
        if !there.is_empty() {
            let size = there.len();
            let own = DMatrix::from_fn(size, size, |i, j| {
                let (k, l) = (there[i], there[j]);
                let one = if i == j { 1.0 } else { 0.0 };
                one + deviations[k] * deviations[l] * self.basis.gram[(k, l)]
            });
            let factor = own.cholesky()?;
            volume = log_determinant(&factor);
            let mut part = DMatrix::from_fn(size, p + 1, |i, j| {
                deviations[there[i]] * self.mixed[(there[i], j)]
            });
            factor.l_dirty().solve_lower_triangular_mut(&mut part);
            gram -= part.tr_mul(&part);
        }
        let mut value = gram[(p, p)] + volume;
        if p > 0 {
            let slope = gram.view((0, p), (p, 1)).column(0) + &self.pull;
            let mut information = gram.view((0, 0), (p, p)).into_owned();
            for k in 0..p {
                information[(k, k)] += self.precision[k];
            }
            let factor: Cholesky<f64, Dyn> = information.cholesky()?;
            value += log_determinant(&factor) - slope.dot(&factor.solve(&slope));
        }
        Some(-0.5 * value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use search::least_squares::Prior;
    use search::random::{Phase, Streams};

    const SAMPLES: usize = 60;

    fn waves() -> SmoothBasis {
        let phases = [f64::cos, f64::sin];
        let wave = |k: u32| {
            phases.map(|phase| Wave {
                channel: 0,
                cycles: f64::from(k),
                curve: (0..SAMPLES)
                    .map(|i| phase(TAU * f64::from(k) * i as f64 / SAMPLES as f64))
                    .collect(),
            })
        };
        let all: Vec<Wave> = (1..=6).flat_map(wave).collect();
        let columns = DMatrix::from_fn(SAMPLES, all.len(), |i, j| all[j].curve[i]);
        SmoothBasis::new(columns, all, vec![1.0])
    }

    fn variable(deviation: f64) -> Variable {
        Variable {
            start: 0.0,
            lower: -99.0,
            upper: 99.0,
            step: 0.1,
            longest: f64::INFINITY,
            prior: Some(Prior {
                mean: 0.3,
                deviation,
            }),
        }
    }

    /// Compares evidence, relative to that without a discrepancy, with the density of the dense Gaussian `I + J
    /// L^-1 J^T + B S B^T`.
    #[test]
    fn the_evidence_is_that_of_the_dense_gaussian() {
        let basis = waves();
        let variables = [variable(2.0), variable(0.5)];
        let mut stream = Streams::new(3, 1).at(0, Phase::Initial, 0);
        let at = Linearized {
            x: vec![0.4, -0.2],
            residual: DVector::from_fn(SAMPLES, |i, _| (0.2 * i as f64).sin() + stream.normal()),
            jacobian: DMatrix::from_fn(SAMPLES, 2, |i, j| ((3 * i * (j + 1)) % 7) as f64 - 2.0),
        };
        let dense = |own: &Discrepancy| {
            let waves = basis.scaled(own);
            let mut covariance = DMatrix::identity(SAMPLES, SAMPLES) + &waves * waves.transpose();
            let mut left = at.residual.clone();
            for (k, variable) in variables.iter().enumerate() {
                let prior = variable.prior.unwrap();
                let column = at.jacobian.column(k);
                covariance += column * column.transpose() * prior.deviation.powi(2);
                left += column * (prior.mean - at.x[k]);
            }
            let factor = covariance.cholesky().unwrap();
            -0.5 * (left.dot(&factor.solve(&left)) + log_determinant(&factor))
        };
        let own = |deviation: f64, length: f64| Discrepancy {
            deviations: vec![deviation],
            length,
        };
        let problem = Problem::new(&basis, &at, &variables);
        let of = |own: &Discrepancy| problem.log_evidence(&basis.coefficients(own)).unwrap();
        let none = own(0.0, 0.1);
        for (deviation, length) in [(0.3, 0.05), (2.0, 0.1), (40.0, 0.2)] {
            let one = own(deviation, length);
            let (found, exact) = (of(&one) - of(&none), dense(&one) - dense(&none));
            assert!((found - exact).abs() < 1e-6, "{found} {exact}");
        }
        let (best, gain) = basis.likeliest(&at, &variables).expect("a sine is there");
        assert!((gain - (dense(&best) - dense(&none))).abs() < 1e-6);
        let mean: f64 = basis.coefficients(&best).map(|s| 0.5 * s * s).sum();
        assert!((mean.sqrt() - best.deviations[0]).abs() < 1e-9);
    }

    /// Checks that white noise asks for no discrepancy, and a smooth residual for one of about its size.
    #[test]
    fn noise_needs_no_discrepancy() {
        let basis = waves();
        let mut asked = 0;
        for seed in 0..40 {
            let mut stream = Streams::new(seed, 1).at(0, Phase::Initial, 0);
            let residual = |amplitude: f64, noise: &mut dyn FnMut() -> f64| {
                DVector::from_fn(SAMPLES, |i, _| {
                    amplitude * (TAU * 2.0 * i as f64 / SAMPLES as f64).sin() + noise()
                })
            };
            let at = |amplitude: f64, noise: &mut dyn FnMut() -> f64| Linearized {
                x: Vec::new(),
                residual: residual(amplitude, noise),
                jacobian: DMatrix::zeros(SAMPLES, 0),
            };
            let mut noise = || stream.normal();
            let empty = basis.likeliest(&at(0.0, &mut noise), &[]);
            asked += usize::from(empty.is_some_and(|(_, gain)| gain > 3.0));
            let (own, _) = basis.likeliest(&at(3.0, &mut noise), &[]).expect("a wave");
            assert!((1.0..=4.0).contains(&own.deviations[0]), "{own:?}");
        }
        assert!(asked <= 1, "{asked}");
    }
}
