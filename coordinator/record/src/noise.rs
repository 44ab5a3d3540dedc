//! Noise of a record, estimated from the scatter between its cycles.
//!
//! Deviations of the cycles from their mean, with the input's known scatter regressed out, give the
//! covariance of the channels at every entry of their basis, smoothed over neighbouring entries and shrunk
//! towards its diagonal as far as the small number of cycles demands. With one cycle
//! there is no scatter: the noise is then taken from the channels' statements and from the roughness of the
//! curves, and all results are marked as resting on that assumption.
use crate::basis::{Basis, ChannelGroup, smoothed};
use crate::measured::Record;
use crate::scatter::unexplained;
use crate::spectrum::{Orders, Spectra};
use nalgebra::{Complex, DMatrix, DVector};
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};

type C = Complex<f64>;

/// Factor by which a variance stated in a data sheet may be off, either way: noise that is stated in one
/// figure is rarely better known. A residual beyond that is no noise, or not the stated noise.
pub const STATED: f64 = 2.0;

/// Largest factor by which noise variances from few cycles are widened: that of six degrees of freedom. With
/// fewer the variance of Student's distribution is hardly meaningful or does not exist.
pub const WIDEST: f64 = 1.5;

/// Way in which a record's noise is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum NoiseSource {
    /// Measured: estimated from the scatter of several cycles.
    Measured,
    /// Stated: record of a single cycle, with the noise stated for every channel.
    Stated,
    /// Estimated: record of a single cycle without stated noise for some channel, whose noise is taken from
    /// the roughness of its curve.
    Estimated,
}

impl NoiseSource {
    /// Returns whether the noise was estimated from cycles.
    pub const fn is_seen(self) -> bool {
        matches!(self, Self::Measured)
    }
}

/// Noise covariance of the basis coefficients of a record's mean over the cycles.
#[derive(Clone, Debug)]
pub struct Noise {
    /// Noise covariances of the mean over the cycles, by channel group and basis coefficient; each matrix is
    /// channels x channels.
    pub covariances: Vec<Vec<DMatrix<C>>>,
    /// Way in which the noise is known.
    pub known: NoiseSource,
    /// Degrees of freedom of the noise variances, by channel group and basis coefficient; infinite where they
    /// were not estimated from cycles.
    pub freedoms: Vec<Vec<f64>>,
}

impl Noise {
    /// Estimates the noise of a record. `inputs` are curves by which cycles may differ because their input
    /// did (per unit of that input), channel by channel.
    pub fn estimate(record: &Record, groups: &[ChannelGroup], inputs: &[Vec<Vec<f64>>]) -> Self {
        let mut noise = Self::measured(record, groups, inputs);
        noise.add_model_error(record, groups);
        noise
    }

    /// Estimates the noise of the measurement alone, without the model error.
    fn measured(record: &Record, groups: &[ChannelGroup], inputs: &[Vec<Vec<f64>>]) -> Self {
        if record.cycles.len() < 2 {
            let stated = |c: usize| record.noise(c).is_some();
            let known = if (0..record.channels.len()).all(stated) {
                NoiseSource::Stated
            } else {
                NoiseSource::Estimated
            };
            let assume = |group| assumed(record, group);
            return Self {
                covariances: groups.iter().map(assume).collect(),
                known,
                freedoms: groups
                    .iter()
                    .map(|group| vec![f64::INFINITY; group.basis.places()])
                    .collect(),
            };
        }
        let seen = groups.iter().map(|group| seen(record, group, inputs));
        let (covariances, freedoms) = seen.unzip();
        Self {
            covariances,
            known: NoiseSource::Measured,
            freedoms,
        }
    }

    /// Adds the stated model error of the channels to the covariances: equally over all compared basis
    /// coefficients, and independent of the number of cycles.
    fn add_model_error(&mut self, record: &Record, groups: &[ChannelGroup]) {
        for (group, covariances) in groups.iter().zip(&mut self.covariances) {
            let places = covariances.len() as f64;
            for (row, &channel) in group.channels.iter().enumerate() {
                let error = record.channels[channel].model_error.unwrap_or(0.0);
                let weights = &record.channels[channel].channel.weights;
                let slow = group.basis.slow();
                let mean = weights.iter().map(|w| w * w).sum::<f64>() / weights.len().max(1) as f64;
                for (place, covariance) in covariances.iter_mut().enumerate() {
                    let variance = match &group.basis {
                        // orders share the mean square, twice each
                        Basis::Orders(_) => error * error / (2.0 * places),
                        Basis::Samples(_) if weights.is_empty() => error * error,
                        // slow curves have something of every value
                        Basis::Samples(_) if place < slow => error * error * mean,
                        Basis::Samples(_) => {
                            let first = weights.len().saturating_sub(group.basis.places());
                            error * error * weights[place + first].powi(2)
                        }
                    };
                    covariance[(row, row)] += C::from(variance);
                }
            }
        }
    }

    /// Adds an error with known basis coefficients (for example the numerical error of the model) to the
    /// covariances, by channel, smoothed over neighbouring coefficients and independent between channels.
    pub fn add_error(&mut self, groups: &[ChannelGroup], spectra: &[Vec<C>]) {
        for (group, covariances) in groups.iter().zip(&mut self.covariances) {
            for (row, &channel) in group.channels.iter().enumerate() {
                let powers: Vec<f64> = spectra[channel].iter().map(C::norm_sqr).collect();
                let means = smoothed(&group.basis, &powers);
                for (covariance, mean) in covariances.iter_mut().zip(means) {
                    covariance[(row, row)] += C::from(mean);
                }
            }
        }
    }
}

/// Estimates covariances from the scatter between cycles, with the degrees of freedom of each entry's
/// variance.
///
/// Slow curves of samples have a variance of their own, never less than that of the neighbouring samples.
/// Because of their few degrees of freedom `nu` it is widened by the ratio of Student's 95 % interval to the
/// normal one: two cycles determine a mean to a factor of six. The variance of a channel over all its entries
/// is at least half of the stated variance: a data sheet may be off by as much, a few cycles by more.
fn seen(
    record: &Record,
    group: &ChannelGroup,
    inputs: &[Vec<Vec<f64>>],
) -> (Vec<DMatrix<C>>, Vec<f64>) {
    let basis = &group.basis;
    let of = |curves: &Vec<Vec<f64>>| group.transform(curves);
    let inputs: Vec<Spectra> = inputs.iter().map(of).collect();
    let deviations = unexplained(record.cycles.iter().map(of).collect(), &inputs);
    let cycles = deviations.len() as f64;
    let freedom = cycles - 1.0 - inputs.len() as f64 / 10.0;
    let (channels, parts) = (group.channels.len(), basis.parts() as f64);
    let about = |place: usize| {
        let mut sum = DMatrix::<C>::zeros(channels, channels);
        let mut terms = 0.0;
        for k in basis.neighbours(place) {
            for cycle in &deviations {
                let d = DVector::from_fn(channels, |c, _| cycle[c][k]);
                sum += &d * d.adjoint();
            }
            terms += freedom;
        }
        let (mut covariance, coupled) = shrink(sum / C::from(terms), 0.5 * parts * terms);
        if group.is_periodic() {
            covariance *= C::from(widening(terms, coupled) / widening(terms, 1.0));
        }
        (covariance, parts * terms)
    };
    let slow = basis.slow();
    let beside = (0 < slow && slow < basis.places()).then(|| about(slow).0);
    let each = (0..basis.places()).map(|place| {
        let (mut covariance, mut freedom) = about(place);
        if place < slow {
            let wide = student(freedom) / student(f64::INFINITY);
            covariance *= C::from(wide * wide);
            // that is in it
            freedom = f64::INFINITY;
            if let Some(beside) = &beside {
                at_least(&mut covariance, beside);
            }
        }
        (covariance / C::from(cycles), freedom)
    });
    let (mut covariances, freedoms): (Vec<DMatrix<C>>, Vec<f64>) = each.unzip();
    for (row, &channel) in group.channels.iter().enumerate() {
        let Some(stated) = record.noise(channel) else {
            continue;
        };
        let fast = slow.min(covariances.len())..;
        let own: f64 = covariances[fast.clone()]
            .iter()
            .map(|s| s[(row, row)].re)
            .sum();
        let count = covariances[fast].len() as f64;
        let least = basis.variance_of_noise(stated) * count / (STATED * cycles);
        if own < least {
            let by = if own > 0.0 { (least / own).sqrt() } else { 0.0 };
            for covariance in &mut covariances {
                covariance.row_mut(row).scale_mut(by);
                covariance.column_mut(row).scale_mut(by);
                if own <= 0.0 {
                    covariance[(row, row)] = C::from(least / count);
                }
            }
        }
    }
    (covariances, freedoms)
}

/// Raises each variance of a covariance matrix to at least that of another one, keeping the correlations.
fn at_least(covariance: &mut DMatrix<C>, least: &DMatrix<C>) {
    for k in 0..covariance.nrows() {
        let (own, least) = (covariance[(k, k)].re, least[(k, k)].re);
        if own < least {
            // of nothing there is nothing to keep
            let by = if own > 0.0 { (least / own).sqrt() } else { 0.0 };
            covariance.row_mut(k).scale_mut(by);
            covariance.column_mut(k).scale_mut(by);
            covariance[(k, k)] = C::from(least);
        }
    }
}

/// Returns diagonal covariances for a single cycle: the larger of the stated noise and the roughness of the
/// curve.
fn assumed(record: &Record, group: &ChannelGroup) -> Vec<DMatrix<C>> {
    let variance = |c: &usize| {
        let curve = record.cycles.first().map_or(&[][..], |cycle| &cycle[*c]);
        let stated = record.noise(*c).unwrap_or(0.0);
        match &group.basis {
            Basis::Orders(orders) => {
                let n = orders.samples();
                let all = Orders::new(n, n / 2);
                let above = orders.highest() + 1..=n / 2;
                let count = above.clone().count().max(1) as f64;
                let seen: f64 = above.map(|k| all.coefficient(curve, k).norm_sqr()).sum();
                (seen / count).max(stated * stated / n as f64)
            }
            // values of a channel with a zero may be those of different things: they need not be smooth
            Basis::Samples(samples) if samples[0].is_absolute() && stated > 0.0 => stated * stated,
            // a third difference of independent values has twenty times their variance
            Basis::Samples(_) => {
                let third = curve
                    .windows(4)
                    .map(|y| y[0] - 3.0 * y[1] + 3.0 * y[2] - y[3]);
                let count = third.len().max(1) as f64;
                let seen: f64 = third.map(|d| d * d / 20.0).sum();
                (seen / count).max(stated * stated)
            }
        }
    };
    let variances: Vec<f64> = group.channels.iter().map(variance).collect();
    let at = |place: usize| {
        let each = variances.iter().zip(&group.channels);
        let each = each.map(|(variance, &c)| {
            C::from(variance * group.basis.shape_of_noise(record.correlation(c), place))
        });
        DMatrix::from_diagonal(&DVector::from_iterator(variances.len(), each))
    };
    (0..group.basis.places()).map(at).collect()
}

/// Returns the factor by which the inverse of a covariance of complex values, estimated from `terms` of them,
/// exceeds the inverse of the true covariance in the mean (complex inverse Wishart distribution); `coupled` is
/// the number of channels whose covariances are estimated together, 1 for a variance. At most [`WIDEST`].
pub fn widening(terms: f64, coupled: f64) -> f64 {
    if terms > coupled {
        (terms / (terms - coupled)).min(WIDEST)
    } else {
        WIDEST
    }
}

/// Shrinks a covariance towards its diagonal: slightly if `terms`, the number of averaged terms, is large,
/// completely if it is small. Returns it with the number of channels that it effectively couples: 1 if it is
/// diagonal.
fn shrink(mut covariance: DMatrix<C>, terms: f64) -> (DMatrix<C>, f64) {
    let channels = covariance.nrows() as f64;
    let keep = 1.0 - (2.0 * (channels + 1.0) / terms).clamp(0.1, 1.0);
    for i in 0..covariance.nrows() {
        for j in 0..covariance.ncols() {
            if i != j {
                covariance[(i, j)] *= C::from(keep);
            }
        }
    }
    (covariance, 1.0 + (channels - 1.0) * keep * keep)
}

/// Returns the half-width of a two-sided 95 % interval in standard deviations: the quantile of Student's
/// distribution with `freedom` degrees of freedom (at least one), 1.96 where the standard deviation is known
/// exactly.
pub fn student(freedom: f64) -> f64 {
    // beyond ten thousand its third digit no longer changes
    StudentsT::new(0.0, 1.0, freedom.clamp(1.0, 1e4))
        .map_or(f64::INFINITY, |law| law.inverse_cdf(0.975))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::Stated;
    use crate::measured::recorded;

    /// Checks that the model error, stated in the unit of an unweighted value, is multiplied by the squared
    /// weight exactly once.
    #[test]
    fn the_model_error_of_a_weighted_value_is_counted_once() {
        let error = 0.1;
        let mut own = recorded(0);
        own.channel.abscissa.period = None;
        own.channel.abscissa.points = (0..12).map(f64::from).collect();
        own.channel.weights = (0..12).map(|k| 1.0 + f64::from(k)).collect();
        own.channel.noise = Some(0.05);
        let mut record = Record {
            condition: 0,
            channels: vec![own],
            cycles: vec![vec![vec![0.0; 12]]],
            held_out: false,
            stated: Stated::default(),
        };
        let groups = ChannelGroup::of(&record, 10, &[]);
        let [group] = &groups[..] else {
            panic!("one channel makes one group");
        };
        let measured = Noise::estimate(&record, &groups, &[]);
        record.channels[0].model_error = Some(error);
        let with_error = Noise::estimate(&record, &groups, &[]);
        let weights = &record.channels[0].channel.weights;
        let first = weights.len() - group.basis.places();
        for place in group.basis.slow()..group.basis.places() {
            let [before, after] =
                [&measured, &with_error].map(|noise| noise.covariances[0][place][(0, 0)].re);
            let expected = (error * weights[place + first]).powi(2);
            assert!(
                (after - before - expected).abs() < 1e-12 * expected.max(before),
                "{place}: {after} - {before} is not {expected}"
            );
        }
    }

    #[test]
    fn half_widths_are_those_of_the_table_of_student() {
        for (freedom, quantile) in [(1.0, 12.706), (9.0, 2.262), (f64::INFINITY, 1.960)] {
            assert!((student(freedom) - quantile).abs() < 1e-3, "{freedom}");
        }
    }
}
