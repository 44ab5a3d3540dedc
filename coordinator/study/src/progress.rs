//! Progress of a search, accumulated over completed evaluations in the order of arrival.
//!
//! For display only: unlike the log it depends on the order of arrival, and it has no influence on results.
use super::log::{EvaluationOutcome, LogEntry};
use search::strategy::Progress;
use std::time::Duration;

/// Progress of a search for display.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgressView {
    /// Current generation of the search.
    pub generation: u32,
    /// Planned number of generations.
    pub generations: u32,
    /// Number of completed evaluations.
    pub completed: u64,
    /// Expected total number of evaluations.
    pub expected: u64,
    /// Number of completed evaluations that failed.
    pub failed: u64,
    /// Number of completed evaluations that were read from an earlier session.
    pub replayed: u64,
    /// Smallest fitness of an individual whose simulation was complete.
    pub best: Option<f64>,
}

impl ProgressView {
    /// Adds an evaluation log entry to the progress.
    pub fn apply(&mut self, entry: &LogEntry, replayed: bool) {
        let complete = entry.ending == EvaluationOutcome::Complete;
        self.add(complete.then_some(entry.fitness), replayed);
    }

    /// Adds a completed evaluation to the progress, with its objective (`None` if it failed); `replayed`
    /// marks one from an earlier session.
    pub(super) fn add(&mut self, objective: Option<f64>, replayed: bool) {
        self.completed += 1;
        self.replayed += u64::from(replayed);
        self.failed += u64::from(objective.is_none());
        let better = objective.filter(|objective| self.best.is_none_or(|best| *objective < best));
        self.best = better.or(self.best);
    }

    /// Updates current generation and expected number of evaluations from the search strategy.
    pub fn plan(&mut self, progress: &Progress) {
        self.generation = progress.generation;
        self.generations = progress.generations;
        self.expected = progress.expected_evaluations.max(self.completed);
    }

    /// Returns the evaluations per second of this session; `computing` is the time for which workers were
    /// computing. None before the first evaluation.
    pub fn rate(&self, computing: Duration) -> Option<f64> {
        let fresh = self.completed - self.replayed;
        let seconds = computing.as_secs_f64();
        (fresh > 0 && seconds > 0.0).then(|| fresh as f64 / seconds)
    }

    /// Returns the time to the expected end; none before the first evaluation of this session.
    pub fn remaining(&self, computing: Duration) -> Option<Duration> {
        let rate = self.rate(computing)?;
        let ahead = self.expected.saturating_sub(self.completed) as f64;
        Some(Duration::from_secs_f64((ahead / rate).min(1e9)))
    }
}
