//! Loaded case, with its notes, separate cycles and effects.
use super::{
    diagnose::DiagnoseEntry,
    effect::{CaseEffect, CaseParameter},
    note::Note,
};
use protocol::case::{Case, Unknown};
use record::Record;
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
        self.apply_effects();
        self
    }

    /// Gives the case the effects of a gene file: effects that it lacks are added, and parameters that are not
    /// searched take the file's values. Parameters that are searched stay as they are, since the values of the
    /// gene file include them.
    pub fn take_effects(&mut self, effects: &[CaseEffect]) {
        for effect in effects {
            let Some(own) = self.effects.iter_mut().find(|own| own.id == effect.id) else {
                self.effects.push(effect.clone());
                continue;
            };
            for (name, parameter) in &effect.parameters {
                let is_searched = |own: &CaseParameter| own.search.is_some();
                if own.parameters.get(name).is_none_or(|own| !is_searched(own)) {
                    let parameter = CaseParameter {
                        search: None,
                        ..parameter.clone()
                    };
                    own.parameters.insert(name.clone(), parameter);
                }
            }
        }
        self.apply_effects();
    }

    /// Sets the effects and their unknowns in the case to those of `effects`.
    fn apply_effects(&mut self) {
        let earlier = std::mem::take(&mut self.case.effects);
        let of_effect = |unknown: &Unknown| {
            let effect = unknown.of_effect();
            effect.is_some_and(|(id, _)| earlier.iter().any(|own| own.id == id))
        };
        self.case.unknowns.retain(|unknown| !of_effect(unknown));
        self.case.effects = self.effects.iter().map(CaseEffect::setting).collect();
        self.case.effect_units = self.effects.iter().map(CaseEffect::units).collect();
        let added = self.effects.iter().flat_map(CaseEffect::genes);
        self.case.unknowns.extend(added);
    }
}
