//! A case as it was read, with what was found on the way.
use super::{effect::CaseEffect, note::Note};
use discrepancy::record::Record;
use protocol::case::Case;
use serde::Deserialize;

/// Where records come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Records {
    /// A test.
    #[default]
    Measured,
    /// A computation.
    Synthetic,
}

/// A case with what was found on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The case.
    pub case: Case,
    /// Remarks that are no errors.
    pub notes: Vec<Note>,
    /// Every cycle of each record by itself, for a diagnosis; only conditions that have a record.
    pub cycles: Vec<Record>,
    /// Whether the case says that its records were computed; never of replaced ones.
    pub synthetic: bool,
    /// Effects as the file states them, with intervals and provenance.
    pub effects: Vec<CaseEffect>,
}

impl Loaded {
    /// The case as it was when effects were found in it: without those whose provenance names it, by its
    /// content hash, as their dataset, and without their genes.
    #[must_use]
    pub fn without_found_in(mut self, dataset: &str) -> Self {
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
