//! Loaded case, with its notes, separate cycles and effects.
use super::{diagnose::DiagnoseEntry, effect::CaseEffect, note::Note};
use discrepancy::record::Record;
use protocol::case::Case;
use serde::Deserialize;

/// Origin of a case's records.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Records {
    /// Records measured on a real machine.
    #[default]
    Measured,
    /// Records computed by a simulation.
    Synthetic,
}

/// Case as loaded from its folder, with remarks, records cycle by cycle, and effects.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// Case in the form that is sent to workers.
    pub case: Case,
    /// Remarks on the case that are not errors.
    pub notes: Vec<Note>,
    /// Records with each cycle separate, for a diagnosis; only conditions that have a record.
    pub cycles: Vec<Record>,
    /// Whether the case declares its records as synthetic; false if `--measured` replaces them.
    pub synthetic: bool,
    /// Effects as the case file states them, with intervals and provenance.
    pub effects: Vec<CaseEffect>,
    /// Settings of a diagnosis.
    pub diagnose: DiagnoseEntry,
}

impl Loaded {
    /// Returns the case as it was before effects were found in it: without the effects whose provenance
    /// states `dataset`, the case's content hash, and without their unknowns.
    #[must_use]
    pub fn without_effects_from(mut self, dataset: &str) -> Self {
        let found = |effect: &CaseEffect| {
            let provenance = effect.provenance.as_ref();
            provenance.and_then(|p| p.dataset.as_deref()) == Some(dataset)
        };
        self.effects.retain(|effect| !found(effect));
        self.case.effects = self.effects.iter().map(CaseEffect::setting).collect();
        self.case.effect_units = self.effects.iter().map(CaseEffect::units).collect();
        let left = &self.case.effects;
        self.case
            .unknowns
            .retain(|unknown| match unknown.of_effect() {
                None => true,
                Some((id, _)) => left.iter().any(|effect| effect.id == id),
            });
        self
    }
}
