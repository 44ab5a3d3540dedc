//! Shared state of all rounds of a diagnosis.
use crate::ground::base::Base;
use crate::inputs::Inputs;
use crate::laboratory::Stage;
use crate::model::experiments::Experiments;

/// Laboratory, inputs and baseline of a diagnosis.
pub(crate) struct Session<'a, L> {
    /// Laboratory that runs the simulations.
    pub(crate) lab: &'a mut L,
    /// Baseline: the recalibrated model and its metric.
    pub(crate) base: &'a Base,
    /// Case, records and candidate effects.
    pub(crate) inputs: &'a Inputs,
}

impl<L> Session<'_, L> {
    /// Creates experiments on the fitted record whose cost counts for a stage.
    pub(crate) fn experiments(&mut self, stage: Stage) -> Experiments<'_, L> {
        Experiments {
            lab: self.lab,
            on: &self.base.on,
            stage,
        }
    }
}
