//! Adaptive normal distribution of a search: covariance matrix adaptation.
//!
//! Points are `x = m + s L z` with `C = L L^T`; mean, covariance and step size follow the better half of a
//! batch (Hansen, "The CMA Evolution Strategy: A Tutorial", arXiv 1604.00772, equations 38 to 53; the
//! whitened step of the mean is the weighted mean of the `z`, so no inverse is needed). It learns
//! correlations between the unknowns, which a search along the axes does not. It handles neither bounds nor
//! termination.
use super::archive::EvaluatedIndividual;
use crate::random::Stream;
use nalgebra::{DMatrix, DVector};

/// Normal search distribution: mean, covariance, step size and evolution paths.
pub(super) struct Distribution {
    pub(super) mean: DVector<f64>,
    covariance: DMatrix<f64>,
    factor: DMatrix<f64>,
    pub(super) sigma: f64,
    sigma_path: DVector<f64>,
    covariance_path: DVector<f64>,
}

pub(super) fn normal(count: usize, stream: &mut Stream) -> DVector<f64> {
    DVector::from_iterator(
        count,
        std::iter::repeat_with(|| stream.normal()).take(count),
    )
}

/// Returns the standard normal vectors from which a batch was drawn, sorted by the results of its points,
/// best first.
pub(super) fn ranked(drawn: &[DVector<f64>], results: &[EvaluatedIndividual]) -> Vec<DVector<f64>> {
    let mut order: Vec<usize> = (0..results.len()).collect();
    order.sort_by(|a, b| results[*a].result.order(results[*b].result));
    order.iter().map(|i| drawn[*i].clone()).collect()
}

/// Returns the magnitudes of the negative recombination weights for the worse half of a batch; the array
/// holds the upper bounds on their sum by the tutorial's equations 50 and 52.
fn negative_weights(count: usize, [one, definite]: [f64; 2]) -> Vec<f64> {
    let parents = count / 2;
    let raw = |rank: usize| libm::log(0.5 * (count as f64 + 1.0)) - libm::log(rank as f64);
    let worse: Vec<f64> = (parents + 1..=count).map(|rank| -raw(rank)).collect();
    let total: f64 = worse.iter().sum();
    let squares: f64 = worse.iter().map(|weight| weight * weight).sum();
    let mass = total * total / squares;
    // equation 51
    let by_mass = 1.0 + 2.0 * mass / (mass + 2.0);
    let sum = one.min(by_mass).min(definite).max(0.0);
    worse.iter().map(|weight| weight / total * sum).collect()
}

impl Distribution {
    /// Creates a distribution with this mean, the given standard deviation of each unknown, and step size 1.
    pub(super) fn new(mean: DVector<f64>, spread: &DVector<f64>) -> Self {
        let factor = DMatrix::from_diagonal(spread);
        let n = mean.len();
        Self {
            mean,
            covariance: &factor * &factor,
            factor,
            sigma: 1.0,
            sigma_path: DVector::zeros(n),
            covariance_path: DVector::zeros(n),
        }
    }

    /// Returns the search point `m + s L z` for a vector `z` of standard normal numbers.
    pub(super) fn point(&self, z: &DVector<f64>) -> DVector<f64> {
        &self.mean + self.sigma * (&self.factor * z)
    }

    /// Returns the largest standard deviation of any unknown.
    pub(super) fn max_deviation(&self) -> f64 {
        self.sigma * libm::sqrt(self.covariance.diagonal().max())
    }

    /// Updates the distribution by one generation of standard normal vectors, ordered best first; `round`
    /// counts from 1. `active` also moves the covariance away from the worse half (equations 49 to 53), with
    /// pycma's rate of the step size.
    pub(super) fn update(&mut self, ranked: &[DVector<f64>], round: u32, active: bool) {
        let n = self.mean.len() as f64;
        let parents = ranked.len() / 2;
        let raw =
            (1..=parents).map(|rank| libm::log(parents as f64 + 0.5) - libm::log(rank as f64));
        let raw: Vec<f64> = raw.collect();
        let total: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|weight| weight / total).collect();
        let mass = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();

        // pycma's step follows a little faster than the tutorial's
        let c_sigma = (mass + 2.0) / (n + mass + if active { 3.0 } else { 5.0 });
        let overshoot = (libm::sqrt((mass - 1.0) / (n + 1.0)) - 1.0).max(0.0);
        let d_sigma = 1.0 + 2.0 * overshoot + c_sigma;
        let c_path = (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n);
        let c_one = 2.0 / ((n + 1.3) * (n + 1.3) + mass);
        let c_mu =
            (1.0 - c_one).min(2.0 * (mass - 2.0 + 1.0 / mass) / ((n + 2.0) * (n + 2.0) + mass));
        let expected = libm::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));

        let mut z_mean = DVector::zeros(self.mean.len());
        for (z, weight) in ranked.iter().zip(&weights) {
            z_mean += *weight * z;
        }
        let step = &self.factor * &z_mean;
        self.mean += self.sigma * &step;
        self.sigma_path = (1.0 - c_sigma) * &self.sigma_path
            + libm::sqrt(c_sigma * (2.0 - c_sigma) * mass) * &z_mean;
        let decay = 1.0 - libm::pow(1.0 - c_sigma, 2.0 * f64::from(round));
        let length = self.sigma_path.norm();
        let fresh = length / libm::sqrt(decay) < (1.4 + 2.0 / (n + 1.0)) * expected;
        let gate = if fresh { 1.0 } else { 0.0 };
        self.covariance_path = (1.0 - c_path) * &self.covariance_path
            + gate * libm::sqrt(c_path * (2.0 - c_path) * mass) * &step;

        let lost = (1.0 - gate) * c_path * (2.0 - c_path);
        let mut covariance = (1.0 - c_one - c_mu + c_one * lost) * &self.covariance
            + c_one * &self.covariance_path * self.covariance_path.transpose();
        for (z, weight) in ranked.iter().zip(&weights) {
            let y = &self.factor * z;
            covariance += c_mu * *weight * &y * y.transpose();
        }
        if active && c_mu > 0.0 {
            let bound = [1.0 + c_one / c_mu, (1.0 - c_one - c_mu) / (n * c_mu)];
            for (z, weight) in ranked[parents..]
                .iter()
                .zip(negative_weights(ranked.len(), bound))
            {
                let y = &self.factor * z;
                let length = z.norm_squared().max(f64::MIN_POSITIVE);
                covariance -= c_mu * weight * n / length * &y * y.transpose();
                // what is taken off the sum of weights
                covariance += c_mu * weight * &self.covariance;
            }
        }
        self.sigma *= libm::exp((c_sigma / d_sigma * (length / expected - 1.0)).min(1.0));
        // rounding may cost definiteness only after very long runs: then keep the last factor
        if let Some(cholesky) = covariance.clone().cholesky() {
            self.covariance = covariance;
            self.factor = cholesky.unpack();
        }
    }
}
