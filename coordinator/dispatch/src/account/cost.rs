//! What every job of a run cost, by its number.
use protocol::event::Finished;
use std::collections::BTreeMap;

/// What one job cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JobCost {
    /// Time in the slot \[s\].
    pub wall_s: f64,
    /// Processor time meanwhile \[s\]; 0 if it came to no answer.
    pub processor_s: f64,
    /// Newton iterations of its simulation; 0 where nothing was simulated.
    pub newton_iterations: u64,
}

impl JobCost {
    fn of(finished: &Finished) -> Self {
        let simulated = finished.outcome.simulation();
        Self {
            wall_s: finished.cost.wall_s(),
            processor_s: finished.cost.cpu_s(),
            newton_iterations: simulated.map_or(0, |(_, counters)| counters.newton_iterations),
        }
    }
}

/// Every job's cost.
pub type Costs = BTreeMap<u64, JobCost>;

/// Adds a result.
pub(super) fn add(costs: &mut Costs, finished: &Finished) {
    costs.insert(finished.job().0, JobCost::of(finished));
}
