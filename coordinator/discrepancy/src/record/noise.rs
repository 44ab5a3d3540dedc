//! The noise of a record, from the scatter between its cycles.
//!
//! Deviations of the cycles from their mean, with the input's known scatter regressed out, give the
//! covariance of the channels at every order, smoothed over neighbouring orders and shrunk towards
//! its diagonal as far as the few cycles demand (DISCOVERY: noise model). With one cycle there is no
//! scatter: then the orders above those that are compared, and the data sheet, stand for it, and
//! everything that follows is marked as resting on assumed noise.
use crate::record::measured::Record;
use crate::record::spectrum::Orders;
use nalgebra::{Complex, DMatrix, DVector};

type C = Complex<f64>;

/// Covariance of the mean coefficients.
#[derive(Clone, Debug)]
pub struct Noise {
    /// Order by order, channels x channels, of the mean over the cycles.
    pub covariances: Vec<DMatrix<C>>,
    /// Whether it was assumed rather than seen.
    pub assumed: bool,
    /// Degrees of freedom behind a variance, of the least well known order; infinite where assumed.
    pub freedom: f64,
}

/// Half-width of the smoothing over orders.
fn reach(order: usize) -> usize {
    match order {
        0..=5 => 2,
        6..=20 => 3,
        21..=60 => 6,
        _ => 12,
    }
}

impl Noise {
    /// From a record; `inputs` are curves by which cycles may differ because their input did (per
    /// unit of that input), channel by channel.
    pub fn estimate(record: &Record, orders: &Orders, inputs: &[Vec<Vec<C>>]) -> Self {
        if record.cycles.len() < 2 {
            return Self::assume(record, orders);
        }
        let deviations = deviations(record, orders, inputs);
        let cycles = deviations.len() as f64;
        let freedom = cycles - 1.0 - inputs.len() as f64 / 10.0;
        let channels = record.channels.len();
        let mut least = f64::INFINITY;
        let covariances = (1..=orders.highest())
            .map(|order| {
                let reach = reach(order);
                let (from, to) = (order.saturating_sub(reach).max(1), order + reach);
                let mut sum = DMatrix::<C>::zeros(channels, channels);
                let mut terms = 0.0;
                for k in from..=to.min(orders.highest()) {
                    for cycle in &deviations {
                        let d = DVector::from_fn(channels, |c, _| cycle[c][k - 1]);
                        sum += &d * d.adjoint();
                    }
                    terms += freedom;
                }
                least = least.min(2.0 * terms);
                let single = sum / C::from(terms);
                shrink(single, terms) / C::from(cycles)
            })
            .collect();
        Self {
            covariances,
            assumed: false,
            freedom: least,
        }
    }

    /// White above the compared orders, and at least what the data sheet says.
    fn assume(record: &Record, orders: &Orders) -> Self {
        let n = orders.samples();
        let all = Orders::new(n, n / 2);
        let variance = |channel: usize| -> f64 {
            let curve = record
                .cycles
                .first()
                .map_or(&[][..], |cycle| &cycle[channel]);
            let above = orders.highest() + 1..=n / 2;
            let count = above.clone().count().max(1) as f64;
            let seen: f64 = above.map(|k| all.coefficient(curve, k).norm_sqr()).sum();
            let stated = record.channels[channel].channel.noise.unwrap_or(0.0);
            (seen / count).max(stated * stated / n as f64)
        };
        let variances: Vec<f64> = (0..record.channels.len()).map(variance).collect();
        let rho = record.stated.noise_correlation;
        let covariances = (1..=orders.highest())
            .map(|order| {
                // a first-order process is stronger at low orders
                let turn = std::f64::consts::TAU * order as f64 / n as f64;
                let shape = (1.0 - rho * rho) / (1.0 - 2.0 * rho * libm::cos(turn) + rho * rho);
                DMatrix::from_diagonal(&DVector::from_iterator(
                    variances.len(),
                    variances.iter().map(|v| C::from(v * shape.max(1.0))),
                ))
            })
            .collect();
        Self {
            covariances,
            assumed: true,
            freedom: f64::INFINITY,
        }
    }

    /// Adds an error of known spectrum (numerical error of the model, say), smoothed over orders and
    /// taken as independent between channels.
    pub fn add_error(&mut self, spectra: &[Vec<C>]) {
        for (channel, spectrum) in spectra.iter().enumerate() {
            let powers: Vec<f64> = spectrum.iter().map(C::norm_sqr).collect();
            for (covariance, mean) in self.covariances.iter_mut().zip(smoothed(&powers)) {
                covariance[(channel, channel)] += C::from(mean);
            }
        }
    }
}

/// Powers by order, from 1 on, each the mean over its neighbours.
pub(crate) fn smoothed(powers: &[f64]) -> Vec<f64> {
    let highest = powers.len();
    let mean = |order: usize| {
        let reach = reach(order);
        let (from, to) = (
            order.saturating_sub(reach).max(1),
            (order + reach).min(highest),
        );
        powers[from - 1..to].iter().sum::<f64>() / (to + 1 - from) as f64
    };
    (1..=highest).map(mean).collect()
}

/// Deviations of the cycles' coefficients from their mean, less what the inputs explain; cycle,
/// channel, order.
fn deviations(record: &Record, orders: &Orders, inputs: &[Vec<Vec<C>>]) -> Vec<Vec<Vec<C>>> {
    let cycles: Vec<Vec<Vec<C>>> = record
        .cycles
        .iter()
        .map(|cycle| cycle.iter().map(|curve| orders.transform(curve)).collect())
        .collect();
    let n = cycles.len() as f64;
    let channels = record.channels.len();
    let mean = |c: usize, k: usize| cycles.iter().map(|cycle| cycle[c][k]).sum::<C>() / C::from(n);
    let means: Vec<Vec<C>> = (0..channels)
        .map(|c| (0..orders.highest()).map(|k| mean(c, k)).collect())
        .collect();
    cycles
        .into_iter()
        .map(|mut cycle| {
            for (curve, mean) in cycle.iter_mut().zip(&means) {
                for (f, mean) in curve.iter_mut().zip(mean) {
                    *f -= mean;
                }
            }
            regress_out(&mut cycle, inputs, &means);
            cycle
        })
        .collect()
}

/// Subtracts the best combination of the inputs, each channel weighted by its own size.
fn regress_out(cycle: &mut [Vec<C>], inputs: &[Vec<Vec<C>>], means: &[Vec<C>]) {
    if inputs.is_empty() {
        return;
    }
    let weights: Vec<f64> = means
        .iter()
        .map(|mean| {
            1.0 / mean
                .iter()
                .map(C::norm_sqr)
                .sum::<f64>()
                .max(f64::MIN_POSITIVE)
        })
        .collect();
    let dot = |a: &[Vec<C>], b: &[Vec<C>]| -> f64 {
        let channels = a.iter().zip(b).zip(&weights);
        channels
            .map(|((a, b), w)| w * a.iter().zip(b).map(|(a, b)| (a.conj() * b).re).sum::<f64>())
            .sum()
    };
    let matrix = DMatrix::from_fn(inputs.len(), inputs.len(), |i, j| {
        dot(&inputs[i], &inputs[j])
    });
    let right = DVector::from_fn(inputs.len(), |i, _| dot(&inputs[i], cycle));
    let Some(factor) = matrix.cholesky() else {
        return;
    };
    let amounts = factor.solve(&right);
    for (input, amount) in inputs.iter().zip(amounts.iter()) {
        for (curve, input) in cycle.iter_mut().zip(input) {
            for (f, input) in curve.iter_mut().zip(input) {
                *f -= input * C::from(*amount);
            }
        }
    }
}

/// Towards the diagonal: hardly with many terms, wholly with few.
fn shrink(mut covariance: DMatrix<C>, terms: f64) -> DMatrix<C> {
    let channels = covariance.nrows() as f64;
    let keep = 1.0 - (2.0 * (channels + 1.0) / terms).clamp(0.1, 1.0);
    for i in 0..covariance.nrows() {
        for j in 0..covariance.ncols() {
            if i != j {
                covariance[(i, j)] *= C::from(keep);
            }
        }
    }
    covariance
}
