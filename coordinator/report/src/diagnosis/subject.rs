//! Input data of a diagnosis report.
use crate::data::Origin;
use discrepancy::diagnose::{Diagnosis, Estimate};
use discrepancy::record::Record;
use protocol::announce::{EffectDescriptor, ParameterDescriptor};
use protocol::case::Case;
use study::DiagnosisResult;

/// Finished diagnosis with all data that its report refers to.
#[derive(Clone, Debug)]
pub struct DiagnosisInput<'a> {
    /// Case that was diagnosed.
    pub case: &'a Case,
    /// Measured records of the case, cycle by cycle.
    pub records: &'a [Record],
    /// Candidate effects that were considered, including generic forces without a physical cause.
    pub library: &'a [EffectDescriptor],
    /// Result of the diagnosis, with the cost of each of its stages.
    pub diagnosed: &'a DiagnosisResult,
    /// Provenance of the diagnosis (run, program, digest).
    pub origin: Origin,
    /// Remarks about the case and its records.
    pub notes: &'a [String],
    /// Wall time of the diagnosis, over all sessions (s).
    pub wall_s: f64,
}

impl<'a> DiagnosisInput<'a> {
    /// Returns the diagnosis itself, without the cost of its stages.
    pub(super) const fn diagnosis(&self) -> &'a Diagnosis {
        &self.diagnosed.diagnosis
    }

    /// Returns the measured record of a condition; `None` if there is none with at least one cycle.
    pub(super) fn record(&self, condition: usize) -> Option<&'a Record> {
        let mut records = self.records.iter();
        records.find(|record| record.condition == condition && !record.cycles.is_empty())
    }

    /// Returns the measured record of the calibrated condition.
    pub(super) fn calibrated(&self) -> Option<&'a Record> {
        self.record(self.case.objective.condition)
    }

    /// Returns the description that workers give of an effect.
    pub(super) fn effect(&self, id: &str) -> Option<&'a EffectDescriptor> {
        self.library.iter().find(|effect| effect.id == id)
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
