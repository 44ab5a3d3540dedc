//! Local refinement around the best point: an evolution strategy with covariance adaptation.
//!
//! Each round draws a batch and moves the distribution towards the better half (`covariance.rs`). Only the
//! order of the results counts, so failures are merely ranked last.
use super::{
    archive::{Archive, EvaluatedIndividual},
    covariance::{Distribution, normal, ranked},
    proposal::Purpose,
    setting::{AllowedValues, Setting, SettingsError, check, require, settings},
    stage::{Batch, ProposalDraft, SearchStage},
};
use crate::{
    random::{Phase, Streams},
    space::Space,
};
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

settings! {
    /// Settings of a local refinement.
    pub struct RefineSettings, pub(super) table SETTINGS {
        pub batch: usize = "points per round of the refinement", AllowedValues::Whole(4, 100_000);
        pub rounds: u32 = "rounds of the refinement", AllowedValues::Whole(0, 100_000);
        /// Initial standard deviation of each gene (coordinate); 0 keeps a gene fixed.
        pub spread: Vec<f64>;
    }
}

impl RefineSettings {
    pub(super) fn check(&self, space: &Space) -> Result<(), SettingsError> {
        check(self, SETTINGS)?;
        let spreads = self.spread.len();
        let one_each = "one number per gene";
        require(spreads == space.dimension(), "spread", spreads, one_each)?;
        let negative = self.spread.iter().filter(|spread| **spread < 0.0).count();
        require(negative == 0, "negative spreads", negative, "none")
    }
}

/// Local refinement as one batch-wise part (stage) of a strategy.
pub struct Refine {
    settings: RefineSettings,
    space: Space,
    streams: Streams,
    /// Indices of the genes that the refinement varies.
    moving: Vec<usize>,
    round: u32,
    state: Option<State>,
}

struct State {
    /// Point at which the refinement started, with all genes (coordinate).
    base: Vec<f64>,
    distribution: Distribution,
    /// Standard normal vectors from which the points of the running batch were drawn.
    drawn: Vec<DVector<f64>>,
}

impl Refine {
    /// Creates a refinement from its settings.
    ///
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
        let best = archive.best().filter(|best| best.result.survived())?;
        let base = self.space.point(&best.genes);
        let n = self.moving.len();
        let spread = self.moving.iter().map(|axis| self.settings.spread[*axis]);
        let spread = DVector::from_iterator(n, spread);
        let mean = DVector::from_iterator(n, self.moving.iter().map(|axis| base[*axis]));
        Some(State {
            distribution: Distribution::new(mean, &spread),
            base,
            drawn: Vec::new(),
        })
    }
}

impl SearchStage for Refine {
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
            let z = normal(self.moving.len(), &mut stream);
            let x = state.distribution.point(&z);
            let mut point = state.base.clone();
            for (axis, x) in self.moving.iter().zip(x.iter()) {
                point[*axis] = *x;
            }
            state.drawn.push(z);
            drafts.push(ProposalDraft {
                genes: self.space.values(&point),
                purpose: Purpose::Refinement,
            });
        }
        Some(Batch {
            generation: self.round,
            drafts,
        })
    }

    fn absorb(&mut self, results: &[EvaluatedIndividual]) {
        let Some(state) = &mut self.state else { return };
        let ranked = ranked(&state.drawn, results);
        // a round in which everything failed says nothing about where to go
        if results.iter().any(|result| result.result.survived()) {
            state.distribution.update(&ranked, self.round, false);
        } else {
            state.distribution.sigma *= 0.5;
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
