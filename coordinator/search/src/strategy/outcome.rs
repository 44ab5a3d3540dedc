//! Progress of a search, its best individual, and the reason for its end.
use super::archive::EvaluatedIndividual;
use serde::{Deserialize, Serialize};

/// Reason why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Finish {
    /// End after all planned evaluations.
    Planned,
    /// End because an individual reached the fitness threshold.
    Threshold,
}

/// Progress of a search in generations and evaluations, with the best fitness so far.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// Current generation of the search; 0 is the initial one.
    pub generation: u32,
    /// Planned number of generations of the search.
    pub generations: u32,
    /// Number of results consumed so far, in id order.
    pub evaluations: u64,
    /// Expected total number of evaluations: those so far and those still planned.
    pub expected_evaluations: u64,
    /// Fitness of the best complete individual so far; `None` if there is none.
    pub best_fitness: Option<f64>,
}

/// Best individual found by a search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Best {
    /// Id of the proposal by which the individual was evaluated.
    pub id: u64,
    /// Gene values of the best individual in declared units.
    pub genes: Vec<f64>,
    /// Fitness of the best individual; smaller is better.
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
