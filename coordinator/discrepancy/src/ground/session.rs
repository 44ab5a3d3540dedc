//! What all rounds of a diagnosis work with.
use crate::ground::base::Base;
use crate::inputs::Inputs;
use crate::laboratory::Stage;
use crate::model::experiments::Experiments;

/// A laboratory, what is diagnosed in it, and what every test stands on.
pub(crate) struct Session<'a, L> {
    /// Who simulates.
    pub(crate) lab: &'a mut L,
    /// The recalibrated model and its metric.
    pub(crate) base: &'a Base,
    /// The case, its records and what may be suspected.
    pub(crate) inputs: &'a Inputs,
}

impl<L> Session<'_, L> {
    /// Experiments on the fitted cycles that count for a stage.
    pub(crate) fn experiments(&mut self, stage: Stage) -> Experiments<'_, L> {
        Experiments {
            lab: self.lab,
            on: &self.base.on,
            stage,
        }
    }
}
