//! The result of an evaluation, and which of two is the better.
use std::cmp::Ordering;

/// The result of an evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Told {
    /// What is minimised; of an incomplete simulation a grade that says how far it got. Not a
    /// number counts as the worst failure.
    pub fitness: f64,
    /// Whether the simulation reached its end.
    pub complete: bool,
}

impl Told {
    /// Complete before failed, then by fitness; the smaller is the better. Not a number is last.
    pub fn order(self, other: Self) -> Ordering {
        let key = |told: Self| (!told.complete || told.fitness.is_nan(), told.fitness);
        let ((failed, fitness), (other_failed, other_fitness)) = (key(self), key(other));
        let by_number = || fitness.is_nan().cmp(&other_fitness.is_nan());
        failed
            .cmp(&other_failed)
            .then_with(by_number)
            .then_with(|| fitness.total_cmp(&other_fitness))
    }

    /// Strictly better than another.
    pub fn beats(self, other: Self) -> bool {
        self.order(other) == Ordering::Less
    }

    /// Complete and comparable: fit to be an elite.
    pub fn survived(self) -> bool {
        self.complete && !self.fitness.is_nan()
    }
}
