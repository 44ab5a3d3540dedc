//! What a search asks for.
use serde::{Deserialize, Serialize};

/// An individual to evaluate.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// Consecutive from 0.
    pub id: u64,
    /// Gene values in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// The generation it belongs to; 0 is the initial one.
    pub generation: u32,
    /// What it is for.
    pub purpose: Purpose,
}

/// What a proposal is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Purpose {
    /// Member of the initial population.
    Initial,
    /// Child of two parents.
    Offspring,
    /// Trial of the crossover-based hill climb.
    CrossoverTrial,
    /// Trial of the mutation-based hill climb.
    MutationTrial,
    /// Station of a line scan.
    Scan,
    /// Step of a local refinement.
    Refinement,
    /// Column or step of a descent of the residual vector.
    LeastSquares,
    /// A point of such a descent with its derivatives.
    Derivatives,
}

impl Purpose {
    /// As written in tables and files.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Initial => "initial",
            Self::Offspring => "offspring",
            Self::CrossoverTrial => "crossover_trial",
            Self::MutationTrial => "mutation_trial",
            Self::Scan => "scan",
            Self::Refinement => "refinement",
            Self::LeastSquares => "least_squares",
            Self::Derivatives => "derivatives",
        }
    }

    /// Whether the residual vector is wanted beside the fitness.
    pub const fn wants_residual(self) -> bool {
        matches!(self, Self::LeastSquares | Self::Derivatives)
    }

    /// Whether its derivatives are wanted, too.
    pub const fn wants_derivatives(self) -> bool {
        matches!(self, Self::Derivatives)
    }
}
