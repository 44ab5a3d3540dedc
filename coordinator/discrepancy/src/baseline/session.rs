//! Shared state of all rounds of a diagnosis.
use crate::baseline::base::Baseline;
use crate::inputs::Inputs;
use crate::laboratory::{Laboratory, Stage};
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use search::least_squares::LeastSquaresSettings;

/// Simulator, inputs and baseline of a running diagnosis.
pub(crate) struct Session<'a, L> {
    /// Simulator that runs the experiments of the diagnosis.
    pub(crate) lab: &'a mut L,
    /// Baseline: the recalibrated model and its metric.
    pub(crate) base: &'a Baseline,
    /// Inputs of the diagnosis: case, records and candidate effects.
    pub(crate) inputs: &'a Inputs,
}

impl<L: Laboratory> Session<'_, L> {
    /// Fits an answer without the effect at a position, all others kept: the baseline where there is no other.
    /// `None` if the fit fails.
    ///
    /// # Errors
    /// Those of the laboratory.
    pub(crate) async fn fit_without(
        &mut self,
        answer: &Fit,
        position: usize,
    ) -> Result<Option<Fit>, L::Error> {
        if answer.model.added.len() == 1 {
            return Ok(Some(self.base.fit.clone()));
        }
        let start = answer.point().without(position);
        let mut experiments = self.experiments(Stage::Refit);
        experiments.fit(start, LeastSquaresSettings::short(6)).await
    }
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
