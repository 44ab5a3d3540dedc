//! Proposals: the individuals that a search asks to be evaluated.
use serde::{Deserialize, Serialize};

/// Individual that a search asks to be evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// Id of the proposal, consecutive from 0 over the run.
    pub id: u64,
    /// Gene values of the individual in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// Generation of the search to which the individual belongs; 0 is the initial one.
    pub generation: u32,
    /// Purpose for which the individual is evaluated, such as member of the initial population.
    pub purpose: Purpose,
}

/// Purpose for which a search proposes an individual.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Purpose {
    /// Member of the initial population.
    Initial,
    /// Child of two parents in a memetic search.
    Offspring,
    /// Trial of the hill climb in which the elite is crossed with partners.
    CrossoverTrial,
    /// Trial of the hill climb in which random bits of the elite are flipped.
    MutationTrial,
    /// Grid point (station) of a line scan.
    Scan,
    /// Point of a local refinement by an evolution strategy.
    Refinement,
    /// Point of a least-squares descent: a difference point for a Jacobian column, or a trial step.
    LeastSquares,
    /// Point of a least-squares descent, evaluated with its derivatives.
    Derivatives,
}

impl Purpose {
    /// All purposes.
    const ALL: [Self; 8] = [
        Self::Initial,
        Self::Offspring,
        Self::CrossoverTrial,
        Self::MutationTrial,
        Self::Scan,
        Self::Refinement,
        Self::LeastSquares,
        Self::Derivatives,
    ];

    /// Returns the purpose of a name, as [`Self::as_str`] returns it.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|own| own.as_str() == name)
    }

    /// Returns the name of the purpose as written in tables and files.
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

    /// Returns whether proposals with this purpose need the residual vector in addition to the fitness.
    pub const fn wants_residual(self) -> bool {
        matches!(self, Self::LeastSquares | Self::Derivatives)
    }

    /// Returns whether proposals with this purpose need the derivatives of the residual vector.
    pub const fn wants_derivatives(self) -> bool {
        matches!(self, Self::Derivatives)
    }
}
