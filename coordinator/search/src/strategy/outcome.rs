//! How far a search has come, what it found, and why it ended.
use super::archive::Evaluated;
use serde::{Deserialize, Serialize};

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Finish {
    /// Everything that was planned has been evaluated.
    Planned,
    /// The fitness threshold was reached.
    Threshold,
}

/// How far a search has come.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// The current generation; 0 is the initial one.
    pub generation: u32,
    /// How many generations are planned.
    pub generations: u32,
    /// Results consumed, in id order.
    pub evaluations: u64,
    /// How many evaluations to expect in all: those so far and those still planned.
    pub expected_evaluations: u64,
    /// Fitness of the best complete individual.
    pub best_fitness: Option<f64>,
}

/// The best individual of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Best {
    /// Id of its proposal.
    pub id: u64,
    /// Gene values in declared units.
    pub genes: Vec<f64>,
    /// Its fitness.
    pub fitness: f64,
    /// False only if every individual failed.
    pub complete: bool,
}

impl From<&Evaluated> for Best {
    fn from(found: &Evaluated) -> Self {
        Self {
            id: found.id,
            genes: found.genes.clone(),
            fitness: found.told.fitness,
            complete: found.told.survived(),
        }
    }
}
