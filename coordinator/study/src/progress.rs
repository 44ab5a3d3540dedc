//! How far a calibration has come, as a fold over completed evaluations in the order of arrival.
//!
//! It is for people to watch: unlike the log it depends on arrival, and decides nothing.
use super::{
    log::{Ending, Entry},
    watch::View,
};
use search::strategy::{Progress, Proposal};
use std::time::Duration;

/// What a progress display shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgressView {
    /// Generation the search is in.
    pub generation: u32,
    /// Generations it plans.
    pub generations: u32,
    /// Evaluations that came back.
    pub completed: u64,
    /// Evaluations to expect in all.
    pub expected: u64,
    /// Of those that came back, how many failed.
    pub failed: u64,
    /// How many came from an earlier session.
    pub replayed: u64,
    /// Smallest fitness of a complete individual so far.
    pub best: Option<f64>,
}

impl View for ProgressView {
    type Reason = Proposal;
}

impl ProgressView {
    /// Takes one completed evaluation.
    pub fn apply(&mut self, entry: &Entry, replayed: bool) {
        let complete = entry.ending == Ending::Complete;
        self.add(complete.then_some(entry.fitness), replayed);
    }

    /// The same of its objective, if it was complete.
    pub(super) fn add(&mut self, objective: Option<f64>, replayed: bool) {
        self.completed += 1;
        self.replayed += u64::from(replayed);
        self.failed += u64::from(objective.is_none());
        let better = objective.filter(|objective| self.best.is_none_or(|best| *objective < best));
        self.best = better.or(self.best);
    }

    /// Takes what the search plans.
    pub fn plan(&mut self, progress: &Progress) {
        self.generation = progress.generation;
        self.generations = progress.generations;
        self.expected = progress.expected_evaluations.max(self.completed);
    }

    /// Evaluations per second of this session, in which workers have been computing for so long; none
    /// before the first.
    pub fn rate(&self, computing: Duration) -> Option<f64> {
        let fresh = self.completed - self.replayed;
        let seconds = computing.as_secs_f64();
        (fresh > 0 && seconds > 0.0).then(|| fresh as f64 / seconds)
    }

    /// Time to the expected end; none before the first evaluation of this session.
    pub fn remaining(&self, computing: Duration) -> Option<Duration> {
        let rate = self.rate(computing)?;
        let ahead = self.expected.saturating_sub(self.completed) as f64;
        Some(Duration::from_secs_f64((ahead / rate).min(1e9)))
    }
}
