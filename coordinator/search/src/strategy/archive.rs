//! Archive of everything a run has evaluated, in id order.
use super::evaluation_result::EvaluationResult;
use protocol::job::Derivative;
use std::collections::BTreeMap;

/// Evaluated individual: genes, result and, if requested, residual vector.
#[derive(Clone, Debug, PartialEq)]
pub struct EvaluatedIndividual {
    /// Id of the proposal.
    pub id: u64,
    /// Gene values in declared units.
    pub genes: Vec<f64>,
    /// Result of the evaluation.
    pub result: EvaluationResult,
    /// Residual vector, if the search requested it.
    pub residual: Option<Residual>,
}

/// Residual vector of an individual, with its derivatives.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Residual {
    /// Residual values, in units in which their squared norm is the fitness.
    pub values: Vec<f64>,
    /// Derivatives of the residual by unknowns, keyed by their names; empty if they were not requested or the
    /// model does not provide them.
    pub derivatives: BTreeMap<String, Derivative>,
}

/// Archive of all results of a run, searchable by the exact bits of the genes.
#[derive(Clone, Debug, Default)]
pub struct Archive {
    entries: Vec<EvaluatedIndividual>,
    by_genes: BTreeMap<Vec<u64>, usize>,
    best: Option<usize>,
}

impl Archive {
    /// Returns all results in id order.
    pub fn entries(&self) -> &[EvaluatedIndividual] {
        &self.entries
    }

    /// Returns the best individual: complete before failed, then by fitness, then by id.
    pub fn best(&self) -> Option<&EvaluatedIndividual> {
        self.best.and_then(|index| self.entries.get(index))
    }

    /// Returns the result for exactly these genes.
    pub fn find(&self, genes: &[f64]) -> Option<&EvaluatedIndividual> {
        let index = self.by_genes.get(&key(genes))?;
        self.entries.get(*index)
    }

    /// Returns the individuals with a complete simulation and a fitness that is not NaN, best first; ties in
    /// id order.
    pub fn ranked(&self) -> Vec<&EvaluatedIndividual> {
        let mut ranked: Vec<_> = self
            .entries
            .iter()
            .filter(|e| e.result.survived())
            .collect();
        ranked.sort_by(|a, b| a.result.order(b.result));
        ranked
    }

    pub(super) fn push(&mut self, entry: EvaluatedIndividual) {
        let index = self.entries.len();
        if self
            .best()
            .is_none_or(|best| entry.result.beats(best.result))
        {
            self.best = Some(index);
        }
        self.by_genes.entry(key(&entry.genes)).or_insert(index);
        self.entries.push(entry);
    }
}

/// Returns the bits of a gene vector, as a map key.
pub(super) fn key(genes: &[f64]) -> Vec<u64> {
    genes.iter().map(|gene| gene.to_bits()).collect()
}
