//! Local refinement around the best point: an evolution strategy with covariance adaptation.
//!
//! Each round draws a batch about a mean, `x = m + s L z` with `C = L L^T`, and moves the mean and
//! the covariance towards the better half (Hansen, "The CMA Evolution Strategy: A Tutorial",
//! arXiv 1604.00772, equations 38 to 47; the whitened step of the mean is the weighted mean of the `z`, so no
//! inverse is needed). It learns which unknowns make up for each other, which no search along the
//! axes does. It uses only the order of the results, so failures are
//! merely last.
use super::{
    archive::{Archive, Evaluated},
    piece::{Batch, Draft, Piece},
    proposal::Purpose,
    setting::{Setting, SettingsError, Values, check, require},
};
use crate::{
    random::{Phase, Streams},
    space::Space,
};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// A local refinement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RefineSettings {
    /// Points per round, at least 4.
    pub batch: usize,
    /// Number of rounds.
    pub rounds: u32,
    /// First standard deviation, gene by gene (coordinate); 0 keeps a gene as it is.
    pub spread: Vec<f64>,
}

impl RefineSettings {
    /// # Errors
    /// If a setting lies outside its range.
    pub(super) fn check(&self, space: &Space) -> Result<(), SettingsError> {
        check(self, SETTINGS)?;
        let spreads = self.spread.len();
        let one_each = "one number per gene";
        require(spreads == space.dimension(), "spread", spreads, one_each)?;
        let negative = self.spread.iter().filter(|spread| **spread < 0.0).count();
        require(negative == 0, "negative spreads", negative, "none")
    }
}

/// What can be set by name.
pub(super) const SETTINGS: &[Setting] = &[
    Setting::new(
        "batch",
        Values::Whole(4, 100_000),
        "points per round of the refinement",
    ),
    Setting::new(
        "rounds",
        Values::Whole(0, 100_000),
        "rounds of the refinement",
    ),
];

/// A local refinement as a piece of a strategy.
pub struct Refine {
    settings: RefineSettings,
    space: Space,
    streams: Streams,
    /// Positions of the genes that move.
    moving: Vec<usize>,
    round: u32,
    state: Option<State>,
}

/// The distribution, in moving genes only.
struct State {
    /// The point the refinement started from, all genes (coordinate).
    base: Vec<f64>,
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
    factor: DMatrix<f64>,
    sigma: f64,
    sigma_path: DVector<f64>,
    covariance_path: DVector<f64>,
    /// The normal numbers behind the running batch.
    drawn: Vec<DVector<f64>>,
}

impl Refine {
    /// # Errors
    /// If a setting lies outside its range.
    pub fn new(
        settings: RefineSettings,
        space: &Space,
        streams: Streams,
    ) -> Result<Self, SettingsError> {
        settings.check(space)?;
        let moves = |axis: &usize| settings.spread[*axis] > 0.0;
        let moving = (0..space.dimension()).filter(moves).collect();
        Ok(Self {
            settings,
            space: space.clone(),
            streams,
            moving,
            round: 0,
            state: None,
        })
    }

    fn begin(&self, archive: &Archive) -> Option<State> {
        let best = archive.best().filter(|best| best.told.survived())?;
        let base = self.space.point(&best.genes);
        let n = self.moving.len();
        let spread = self.moving.iter().map(|axis| self.settings.spread[*axis]);
        let factor = DMatrix::from_diagonal(&DVector::from_iterator(n, spread));
        Some(State {
            mean: DVector::from_iterator(n, self.moving.iter().map(|axis| base[*axis])),
            base,
            covariance: &factor * &factor,
            factor,
            sigma: 1.0,
            sigma_path: DVector::zeros(n),
            covariance_path: DVector::zeros(n),
            drawn: Vec::new(),
        })
    }
}

impl Piece for Refine {
    fn plan(&mut self, archive: &Archive) -> Option<Batch> {
        if self.round >= self.settings.rounds || self.moving.is_empty() {
            self.round = self.settings.rounds;
            return None;
        }
        if self.state.is_none() {
            self.state = self.begin(archive);
        }
        let Some(state) = &mut self.state else {
            self.round = self.settings.rounds;
            return None;
        };
        self.round += 1;
        state.drawn.clear();
        let mut drafts = Vec::with_capacity(self.settings.batch);
        for index in 0..self.settings.batch {
            let mut stream = self.streams.at(self.round, Phase::Refinement, index);
            let z = DVector::from_iterator(
                self.moving.len(),
                std::iter::repeat_with(|| stream.normal()).take(self.moving.len()),
            );
            let x = &state.mean + state.sigma * (&state.factor * &z);
            let mut point = state.base.clone();
            for (axis, x) in self.moving.iter().zip(x.iter()) {
                point[*axis] = *x;
            }
            state.drawn.push(z);
            drafts.push(Draft {
                genes: self.space.values(&point),
                purpose: Purpose::Refinement,
            });
        }
        Some(Batch {
            generation: self.round,
            drafts,
        })
    }

    fn absorb(&mut self, results: &[Evaluated]) {
        let Some(state) = &mut self.state else { return };
        let mut order: Vec<usize> = (0..results.len()).collect();
        order.sort_by(|a, b| results[*a].told.order(results[*b].told));
        let ranked: Vec<DVector<f64>> = order.iter().map(|i| state.drawn[*i].clone()).collect();
        // a round in which everything failed says nothing about where to go
        if results.iter().any(|result| result.told.survived()) {
            state.update(&ranked, self.round);
        } else {
            state.sigma *= 0.5;
        }
        state.drawn.clear();
    }

    fn generations(&self) -> u32 {
        self.settings.rounds
    }

    fn remaining(&self) -> u64 {
        let running = self.state.as_ref().map_or(0, |state| state.drawn.len());
        let ahead = u64::from(self.settings.rounds - self.round);
        running as u64 + ahead * self.settings.batch as u64
    }
}

impl State {
    /// One generation of covariance adaptation from the normal numbers, best first.
    fn update(&mut self, ranked: &[DVector<f64>], round: u32) {
        let n = self.mean.len() as f64;
        let parents = ranked.len() / 2;
        let raw =
            (1..=parents).map(|rank| libm::log(parents as f64 + 0.5) - libm::log(rank as f64));
        let raw: Vec<f64> = raw.collect();
        let total: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|weight| weight / total).collect();
        let mass = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();

        let c_sigma = (mass + 2.0) / (n + mass + 5.0);
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
        self.sigma *= libm::exp((c_sigma / d_sigma * (length / expected - 1.0)).min(1.0));
        // rounding may cost definiteness only after very long runs: then keep the last factor
        if let Some(cholesky) = covariance.clone().cholesky() {
            self.covariance = covariance;
            self.factor = cholesky.unpack();
        }
    }
}
