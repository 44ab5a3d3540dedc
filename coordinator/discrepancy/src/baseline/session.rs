//! Shared state of all rounds of a diagnosis.
use crate::baseline::base::Baseline;
use crate::inputs::Inputs;
use crate::laboratory::Stage;
use crate::model::experiments::Experiments;

/// Simulator, inputs and baseline of a running diagnosis.
pub(crate) struct Session<'a, L> {
    /// Simulator that runs the experiments of the diagnosis.
    pub(crate) lab: &'a mut L,
    /// Baseline: the recalibrated model and its metric.
    pub(crate) base: &'a Baseline,
    /// Inputs of the diagnosis: case, records and candidate effects.
    pub(crate) inputs: &'a Inputs,
}

impl<L> Session<'_, L> {
    /// Creates an interface for simulations of the fitted record that are charged to the budget of a stage.
    pub(crate) fn experiments(&mut self, stage: Stage) -> Experiments<'_, L> {
        Experiments {
            lab: self.lab,
            on: &self.base.record,
            stage,
        }
    }
}
