//! What a diagnosis may cost: simulations by stage. Clocks decide nothing, so that one worker or eighty say the
//! same.
//!
//! A stage that has used up its part begins nothing new that it could do without: no further valley, round
//! or challenger. What was begun is finished, so the part is a bound to within one such look.
use crate::laboratory::{Laboratory, Stage};
use protocol::job::{Observation, SimulateSpec};

/// A laboratory that counts.
pub(crate) struct Budgeted<'a, L> {
    lab: &'a mut L,
    /// What each stage has left, in plain simulations.
    left: [f64; Stage::ALL.len()],
    /// The stages that were refused something.
    ran_out: Vec<Stage>,
}

impl<'a, L> Budgeted<'a, L> {
    pub(crate) fn new(lab: &'a mut L, budget: &[u32; Stage::ALL.len()]) -> Self {
        Self {
            lab,
            left: budget.map(f64::from),
            ran_out: Vec::new(),
        }
    }

    /// Stages that could not begin something.
    pub(crate) fn ran_out(&self) -> &[Stage] {
        &self.ran_out
    }
}

/// What a simulation costs, in plain ones: derivatives four more, and each a tenth.
pub fn cost(spec: &SimulateSpec) -> f64 {
    let columns = spec.columns.len() as f64;
    if spec.columns.is_empty() {
        1.0
    } else {
        5.0 + 0.1 * columns
    }
}

impl<L: Laboratory> Laboratory for Budgeted<'_, L> {
    type Error = L::Error;

    fn differentiates(&self) -> bool {
        self.lab.differentiates()
    }

    fn may(&mut self, stage: Stage) -> bool {
        let left = self.left[stage as usize] > 0.0;
        if !left && !self.ran_out.contains(&stage) {
            self.ran_out.push(stage);
        }
        left
    }

    fn left(&self, stage: Stage) -> f64 {
        self.left[stage as usize]
    }

    async fn observe(
        &mut self,
        stage: Stage,
        batch: Vec<SimulateSpec>,
    ) -> Result<Vec<Option<Observation>>, L::Error> {
        self.left[stage as usize] -= batch.iter().map(cost).sum::<f64>();
        self.lab.observe(stage, batch).await
    }
}
