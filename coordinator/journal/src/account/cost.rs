//! Cost of each job of a run, by job number.
use crate::event::Finished;
use std::collections::BTreeMap;

/// Cost of one job.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JobCost {
    /// Wall-clock time that the job occupied its slot \[s\].
    pub wall_s: f64,
    /// Processor time \[s\]; 0 for a job without an answer.
    pub processor_s: f64,
    /// Newton iterations of the job's simulation; 0 if nothing was simulated.
    pub newton_iterations: u64,
}

impl JobCost {
    /// Returns the cost of a finished job.
    pub fn of(finished: &Finished) -> Self {
        let simulated = finished.outcome.simulation();
        Self {
            wall_s: finished.cost.wall_s(),
            processor_s: finished.cost.cpu_s(),
            newton_iterations: simulated.map_or(0, |(_, counters)| counters.newton_iterations),
        }
    }
}

/// Cost of each job, by job number.
pub type Costs = BTreeMap<u64, JobCost>;

/// Records the cost of a finished job in the table of costs.
pub(super) fn add(costs: &mut Costs, finished: &Finished) {
    costs.insert(finished.job().0, JobCost::of(finished));
}
