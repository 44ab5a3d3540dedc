//! Division of simulations by columns, for tests.
use super::Divide;
use protocol::job::{Job, Outcome, division};

/// Returns the smallest number of parts of an anticipated job: those of two columns.
pub(crate) fn halves(units: usize) -> usize {
    units.div_ceil(2).max(1)
}

/// Division of simulations by columns.
#[derive(Debug)]
pub(crate) struct ByColumns;

impl Divide for ByColumns {
    fn units(&self, job: &Job) -> usize {
        division::shared_columns(job)
    }

    fn split(&self, job: Job, size: usize) -> Vec<Job> {
        division::split(job, size)
    }

    fn join(&self, joined: Outcome, next: Outcome) -> Outcome {
        division::join(joined, next)
    }

    fn least_parts(&self, units: usize) -> usize {
        halves(units)
    }
}
