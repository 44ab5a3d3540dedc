//! Intake of results in id order: a search is a function of the longest unbroken run of results from id 0;
//! results that arrive early wait in a buffer.
use super::{
    archive::{Archive, EvaluatedIndividual},
    evaluation_result::EvaluationResult,
};
use std::collections::BTreeMap;

/// Open proposals, results that arrived early, and the archive of consumed results of a search.
#[derive(Default)]
pub(super) struct Intake {
    /// Genes of the proposals whose results have not been consumed, by proposal id.
    open: BTreeMap<u64, Vec<f64>>,
    early: BTreeMap<u64, EvaluationResult>,
    archive: Archive,
}

impl Intake {
    /// Registers a proposal whose result is awaited.
    pub(super) fn expect(&mut self, id: u64, genes: Vec<f64>) {
        self.open.insert(id, genes);
    }

    /// Returns whether the result of proposal `id` has not been consumed yet.
    pub(super) fn awaits(&self, id: u64) -> bool {
        self.open.contains_key(&id)
    }

    pub(super) fn awaited(&self) -> u64 {
        self.open.len() as u64
    }

    /// Buffers a result until its turn; a second result for an id, or one for an id that is not open, is
    /// ignored.
    pub(super) fn keep(&mut self, id: u64, result: EvaluationResult) {
        if self.awaits(id) {
            self.early.entry(id).or_insert(result);
        }
    }

    /// Consumes the result that is next in id order, if it has arrived, and returns its id and value.
    pub(super) fn take(&mut self) -> Option<(u64, EvaluationResult)> {
        let id = self.archive.entries().len() as u64;
        let told = self.early.remove(&id)?;
        let genes = self.open.remove(&id).unwrap_or_default();
        self.archive.push(EvaluatedIndividual {
            id,
            genes,
            result: told,
            residual: None,
        });
        Some((id, told))
    }

    /// Returns the individual of a proposal with its result, consumed or buffered; `None` while the result is
    /// awaited.
    pub(super) fn result(&self, id: u64) -> Option<EvaluatedIndividual> {
        if let Some(genes) = self.open.get(&id) {
            let result = *self.early.get(&id)?;
            return Some(EvaluatedIndividual {
                id,
                genes: genes.clone(),
                result,
                residual: None,
            });
        }
        let index = usize::try_from(id).ok()?;
        self.archive.entries().get(index).cloned()
    }

    /// Replaces the archive's groups of individuals from which the next stage may begin.
    pub(super) fn set_start_groups(&mut self, start_groups: Vec<Vec<Vec<f64>>>) {
        self.archive.set_start_groups(start_groups);
    }

    pub(super) const fn archive(&self) -> &Archive {
        &self.archive
    }
}
