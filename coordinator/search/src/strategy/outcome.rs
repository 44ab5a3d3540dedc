//! Progress, result and end of a search.
use super::archive::EvaluatedIndividual;
use serde::{Deserialize, Serialize};

/// Reason why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Finish {
    /// All planned evaluations are done.
    Planned,
    /// The fitness threshold was reached.
    Threshold,
}

/// Progress of a search.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// Current generation of the search; 0 is the initial one.
    pub generation: u32,
    /// Planned number of generations.
    pub generations: u32,
    /// Number of results consumed so far, in id order.
    pub evaluations: u64,
    /// Expected total number of evaluations: those so far and those still planned.
    pub expected_evaluations: u64,
    /// Fitness of the best complete individual so far; `None` if there is none.
    pub best_fitness: Option<f64>,
}

/// Best individual found by a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Best {
    /// Id of the individual's proposal.
    pub id: u64,
    /// Gene values in declared units.
    pub genes: Vec<f64>,
    /// Fitness of the individual.
    pub fitness: f64,
    /// Whether the individual's simulation completed; false only if every individual failed.
    pub complete: bool,
}

impl From<&EvaluatedIndividual> for Best {
    fn from(found: &EvaluatedIndividual) -> Self {
        Self {
            id: found.id,
            genes: found.genes.clone(),
            fitness: found.result.fitness,
            complete: found.result.survived(),
        }
    }
}
