//! Archive of everything a run has evaluated, in id order.
use super::evaluation_result::EvaluationResult;
use protocol::job::Derivative;
use std::collections::BTreeMap;

/// Evaluated individual: genes, result and, if requested, residual vector.
#[derive(Clone, Debug, PartialEq)]
pub struct EvaluatedIndividual {
    /// Id of the proposal that was evaluated, consecutive from 0 over the run.
    pub id: u64,
    /// Gene values of the individual in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// Fitness of the individual, and whether its simulation completed.
    pub result: EvaluationResult,
    /// Residual vector of the individual, if the search requested it.
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
    start_groups: Vec<Vec<Vec<f64>>>,
}

impl Archive {
    /// Returns all evaluated individuals of the archive, in id order.
    pub fn entries(&self) -> &[EvaluatedIndividual] {
        &self.entries
    }

    /// Returns the best individual: complete before failed, then by fitness, then by id.
    pub fn best(&self) -> Option<&EvaluatedIndividual> {
        self.best.and_then(|index| self.entries.get(index))
    }

    /// Returns the archived result of the individual with exactly these genes.
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

    /// Returns the individuals from which the next stage may begin, in groups: for each group the genes of its
    /// individuals, best first. All that survived are one group, unless the last stage distinguished several.
    pub fn start_groups(&self) -> Vec<Vec<Vec<f64>>> {
        if self.start_groups.is_empty() {
            return vec![self.ranked().iter().map(|one| one.genes.clone()).collect()];
        }
        self.start_groups.clone()
    }

    /// Replaces the groups of individuals from which the next stage may begin.
    pub(super) fn set_start_groups(&mut self, start_groups: Vec<Vec<Vec<f64>>>) {
        self.start_groups = start_groups;
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

pub(super) fn key(genes: &[f64]) -> Vec<u64> {
    genes.iter().map(|gene| gene.to_bits()).collect()
}
