//! Result of evaluating an individual (fitness and completeness), and the ordering of results.
use std::cmp::Ordering;

/// Result of evaluating an individual: its fitness, and whether its simulation completed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvaluationResult {
    /// Fitness, which is minimised; for an incomplete simulation a grade of how far it got. NaN counts as the
    /// worst failure.
    pub fitness: f64,
    /// Whether the individual's simulation reached its end.
    pub complete: bool,
}

impl EvaluationResult {
    /// Compares the results of two individuals: complete before failed, then by fitness, smaller first, NaN
    /// last.
    pub fn order(self, other: Self) -> Ordering {
        let key = |told: Self| (!told.complete || told.fitness.is_nan(), told.fitness);
        let ((failed, fitness), (other_failed, other_fitness)) = (key(self), key(other));
        let by_number = || fitness.is_nan().cmp(&other_fitness.is_nan());
        failed
            .cmp(&other_failed)
            .then_with(by_number)
            .then_with(|| fitness.total_cmp(&other_fitness))
    }

    /// Returns whether this result is strictly better than another.
    pub fn beats(self, other: Self) -> bool {
        self.order(other) == Ordering::Less
    }

    /// Returns whether the simulation completed with a fitness that is not NaN.
    pub fn survived(self) -> bool {
        self.complete && !self.fitness.is_nan()
    }
}
