//! What the report of a diagnosis is about.
use crate::data::Origin;
use discrepancy::diagnose::{Diagnosis, Estimate};
use discrepancy::record::Record;
use protocol::announce::{EffectDescriptor, ParameterDescriptor};
use protocol::case::Case;
use study::Diagnosed;

/// A finished diagnosis with everything that its report names.
#[derive(Clone, Debug)]
pub struct Subject<'a> {
    /// The case.
    pub case: &'a Case,
    /// Its records, cycle by cycle.
    pub records: &'a [Record],
    /// Effects that were considered, forces without a cause included.
    pub library: &'a [EffectDescriptor],
    /// The answer, with the cost of its stages.
    pub diagnosed: &'a Diagnosed,
    /// How it was made.
    pub origin: Origin,
    /// Remarks about case and records.
    pub notes: &'a [String],
    /// Wall time of all sessions (s).
    pub wall_s: f64,
}

impl<'a> Subject<'a> {
    /// The answer.
    pub(super) const fn diagnosis(&self) -> &'a Diagnosis {
        &self.diagnosed.diagnosis
    }

    /// The record of a condition.
    pub(super) fn record(&self, condition: usize) -> Option<&'a Record> {
        let mut records = self.records.iter();
        records.find(|record| record.condition == condition && !record.cycles.is_empty())
    }

    /// The record of the calibrated condition.
    pub(super) fn calibrated(&self) -> Option<&'a Record> {
        self.record(self.case.objective.condition)
    }

    /// What the workers say of an effect.
    pub(super) fn effect(&self, id: &str) -> Option<&'a EffectDescriptor> {
        self.library.iter().find(|effect| effect.id == id)
    }

    /// What they say of one of its parameters.
    pub(super) fn parameter(&self, id: &str, name: &str) -> Option<&'a ParameterDescriptor> {
        let mut parameters = self.effect(id)?.parameters.iter();
        parameters.find(|parameter| parameter.name == name)
    }

    /// Effects that were added to the model.
    pub(super) fn added(&self) -> Vec<&'a Estimate> {
        let (effects, rounds) = (&self.diagnosis().effects, &self.diagnosis().rounds);
        let is_added = |id: &String| rounds.iter().any(|round| round.added.as_ref() == Some(id));
        effects
            .iter()
            .filter(|effect| is_added(&effect.id))
            .collect()
    }
}

/// Names of the channels of a record.
pub(super) fn channels(record: &Record) -> Vec<String> {
    let titles = record.channels.iter().map(|own| own.channel.title.clone());
    titles.collect()
}
