//! Results that arrive in any order, taken in by the order of their ids: what a search does is a function of the
//! longest unbroken run of results from id 0, and later ones wait.
use super::{
    archive::{Archive, Evaluated},
    told::Told,
};
use std::collections::BTreeMap;

/// What was asked for, what has come early, and what was taken in.
#[derive(Default)]
pub(super) struct Intake {
    /// Genes of the proposals that have not been taken in, by id.
    open: BTreeMap<u64, Vec<f64>>,
    early: BTreeMap<u64, Told>,
    archive: Archive,
}

impl Intake {
    /// Awaits the result of a proposal.
    pub(super) fn expect(&mut self, id: u64, genes: Vec<f64>) {
        self.open.insert(id, genes);
    }

    /// Whether a proposal has not been taken in.
    pub(super) fn awaits(&self, id: u64) -> bool {
        self.open.contains_key(&id)
    }

    /// How many proposals have not been taken in.
    pub(super) fn awaited(&self) -> u64 {
        self.open.len() as u64
    }

    /// Keeps a result until its turn; the first counts, and one that nobody awaits does not.
    pub(super) fn keep(&mut self, id: u64, result: Told) {
        if self.awaits(id) {
            self.early.entry(id).or_insert(result);
        }
    }

    /// Takes in the result whose turn it is, if it is there: its id, and what it is.
    pub(super) fn take(&mut self) -> Option<(u64, Told)> {
        let id = self.archive.entries().len() as u64;
        let told = self.early.remove(&id)?;
        let genes = self.open.remove(&id).unwrap_or_default();
        self.archive.push(Evaluated {
            id,
            genes,
            told,
            residual: None,
        });
        Some((id, told))
    }

    /// What was taken in.
    pub(super) const fn archive(&self) -> &Archive {
        &self.archive
    }
}
