//! Everything a run has evaluated, in id order.
use super::told::Told;
use protocol::job::Derivative;
use std::collections::BTreeMap;

/// One evaluated individual.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
    /// Id of its proposal.
    pub id: u64,
    /// Gene values in declared units.
    pub genes: Vec<f64>,
    /// What came back.
    pub told: Told,
    /// The residual vector, for a piece that wanted it.
    pub residual: Option<Residual>,
}

/// The residual vector of an individual.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Residual {
    /// In units in which its squared length is the fitness.
    pub values: Vec<f64>,
    /// Its derivatives by name, one curve each, where they were wanted and the model gives them.
    pub by: BTreeMap<String, Derivative>,
}

/// All results of a run, found again by the exact bits of their genes.
#[derive(Clone, Debug, Default)]
pub struct Archive {
    entries: Vec<Evaluated>,
    by_genes: BTreeMap<Vec<u64>, usize>,
    best: Option<usize>,
}

impl Archive {
    /// In id order.
    pub fn entries(&self) -> &[Evaluated] {
        &self.entries
    }

    /// The best individual: complete before failed, then by fitness, then by id.
    pub fn best(&self) -> Option<&Evaluated> {
        self.best.and_then(|index| self.entries.get(index))
    }

    /// The result of exactly these genes.
    pub fn find(&self, genes: &[f64]) -> Option<&Evaluated> {
        let index = self.by_genes.get(&key(genes))?;
        self.entries.get(*index)
    }

    /// The individuals that survived, best first; ties by id.
    pub fn ranked(&self) -> Vec<&Evaluated> {
        let mut ranked: Vec<_> = self.entries.iter().filter(|e| e.told.survived()).collect();
        ranked.sort_by(|a, b| a.told.order(b.told));
        ranked
    }

    pub(super) fn push(&mut self, entry: Evaluated) {
        let index = self.entries.len();
        if self.best().is_none_or(|best| entry.told.beats(best.told)) {
            self.best = Some(index);
        }
        self.by_genes.entry(key(&entry.genes)).or_insert(index);
        self.entries.push(entry);
    }
}

/// The bits of a gene vector.
pub(super) fn key(genes: &[f64]) -> Vec<u64> {
    genes.iter().map(|gene| gene.to_bits()).collect()
}
