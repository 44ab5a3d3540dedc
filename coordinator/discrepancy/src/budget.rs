//! Budget of a diagnosis: number of simulations per stage. Time is not limited, so that the result does not
//! depend on the number of workers.
//!
//! A stage that has used up its budget begins no further optional work, such as a search for a narrow
//! minimum, a round of tests or the refit of a generic force. Work in progress is finished, so the budget may
//! be exceeded by one such unit.
use crate::laboratory::{Finding, Laboratory, Stage};
use protocol::job::{Observation, SimulateSpec};

/// Simulator that counts simulations and refuses optional work when a stage's budget is used up.
pub(crate) struct Budgeted<'a, L> {
    lab: &'a mut L,
    /// Remaining budget of each stage, in simulations without derivatives.
    left: [f64; Stage::ALL.len()],
    /// Stages that were refused optional work because their budget was used up.
    ran_out: Vec<Stage>,
}

impl<'a, L> Budgeted<'a, L> {
    pub(crate) const fn new(lab: &'a mut L, budget: [f64; Stage::ALL.len()]) -> Self {
        Self {
            lab,
            left: budget,
            ran_out: Vec::new(),
        }
    }

    /// Returns the stages that were refused optional work because their budget was used up.
    pub(crate) fn ran_out(&self) -> &[Stage] {
        &self.ran_out
    }
}

/// Returns the cost of a simulation with a number of derivatives relative to one without: 1, or with derivatives 5 plus
/// 0.1 per derivative.
pub fn cost(columns: usize) -> f64 {
    match columns {
        0 => 1.0,
        some => cost_with_derivatives(some),
    }
}

/// Returns the cost of a simulation with a number of derivatives relative to one without: 5 plus 0.1 per
/// derivative.
pub(crate) fn cost_with_derivatives(columns: usize) -> f64 {
    5.0 + 0.1 * columns as f64
}

impl<L: Laboratory> Laboratory for Budgeted<'_, L> {
    type Error = L::Error;

    fn differentiates(&self) -> bool {
        self.lab.differentiates()
    }

    fn has_budget(&mut self, stage: Stage) -> bool {
        let left = self.left[stage as usize] > 0.0;
        if !left && !self.ran_out.contains(&stage) {
            self.ran_out.push(stage);
        }
        left
    }

    fn left(&self, stage: Stage) -> f64 {
        self.left[stage as usize]
    }

    fn found(&mut self, finding: &Finding) -> Result<(), L::Error> {
        self.lab.found(finding)
    }

    async fn observe(
        &mut self,
        stage: Stage,
        batch: Vec<SimulateSpec>,
    ) -> Result<Vec<Option<Observation>>, L::Error> {
        self.left[stage as usize] -= batch
            .iter()
            .filter(|spec| !self.lab.is_known(spec))
            .map(|spec| cost(spec.columns.len()))
            .sum::<f64>();
        self.lab.observe(stage, batch).await
    }
}
