//! Input data of a diagnosis report.
use crate::assessment::MachineAssessment;
use crate::data::Origin;
use discrepancy::diagnose::{Diagnosis, Estimate};
use discrepancy::laboratory::Stage;
use protocol::announce::{EffectDescriptor, ParameterDescriptor};
use protocol::case::Case;
use record::Record;
use std::time::Duration;
use study::RecordedDiagnosis;

/// Finished diagnosis with all data that its report refers to.
#[derive(Clone, Debug)]
pub struct DiagnosisInput<'a> {
    /// Case that was diagnosed.
    pub case: &'a Case,
    /// Result of the diagnosis, with its records and what it cost.
    pub diagnosed: &'a RecordedDiagnosis,
    /// Provenance of the diagnosis (run, program, digest).
    pub origin: Origin,
    /// Assessments that were made of the answer.
    pub assessments: Vec<MachineAssessment>,
    /// Wall time of the diagnosis, over all sessions (s).
    pub wall_s: f64,
}

impl<'a> DiagnosisInput<'a> {
    /// Returns the diagnosis itself, without the cost of its stages.
    pub(super) const fn diagnosis(&self) -> &'a Diagnosis {
        &self.diagnosed.result.diagnosis
    }

    /// Returns the measured record of a condition; `None` if there is none with at least one cycle.
    pub(super) fn record(&self, condition: usize) -> Option<&'a Record> {
        let mut records = self.diagnosed.records.iter();
        records.find(|record| record.condition == condition && !record.cycles.is_empty())
    }

    /// Returns the measured record of the calibrated condition.
    pub(super) fn calibrated(&self) -> Option<&'a Record> {
        self.record(self.case.objective.condition)
    }

    /// Returns the slot time of the simulations of a stage, summed.
    pub fn busy(&self, stage: Stage) -> Duration {
        let times = &self.diagnosed.slot_times;
        times.get(stage.name()).copied().unwrap_or_default()
    }

    /// Returns the description that workers give of an effect.
    pub(super) fn effect(&self, id: &str) -> Option<&'a EffectDescriptor> {
        self.diagnosed
            .result
            .library
            .iter()
            .find(|effect| effect.id == id)
    }

    /// Returns the description that workers give of a parameter of an effect.
    pub(super) fn parameter(&self, id: &str, name: &str) -> Option<&'a ParameterDescriptor> {
        let mut parameters = self.effect(id)?.parameters.iter();
        parameters.find(|parameter| parameter.name == name)
    }

    /// Returns the estimates of the effects that were added to the model.
    pub(super) fn added(&self) -> Vec<&'a Estimate> {
        let (effects, rounds) = (&self.diagnosis().effects, &self.diagnosis().rounds);
        let is_added = |id: &String| rounds.iter().any(|round| round.added.as_ref() == Some(id));
        effects
            .iter()
            .filter(|effect| is_added(&effect.id))
            .collect()
    }
}

/// Returns the titles of the channels of a record.
pub(super) fn channels(record: &Record) -> Vec<String> {
    let titles = record.channels.iter().map(|own| own.channel.title.clone());
    titles.collect()
}
