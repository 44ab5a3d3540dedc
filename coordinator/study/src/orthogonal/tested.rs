//! An orthogonal test from its runs to what follows of them.
use super::{
    anova::{Anova, anova},
    array::Array,
    range::{Observation, Range, predicted, ranges},
};
use serde::{Deserialize, Serialize};

/// Something with several values that are compared.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Factor {
    /// Its name.
    pub name: String,
    /// Its values in words.
    pub levels: Vec<String>,
}

impl Factor {
    /// From words.
    pub fn new(name: &str, levels: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self {
            name: name.to_owned(),
            levels: levels.into_iter().map(Into::into).collect(),
        }
    }
}

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    /// The level of every factor, from 0.
    pub levels: Vec<usize>,
    /// Its seed; runs of one seed are a block.
    pub seed: u64,
    /// The best objective that it found, in the objective's unit; none where nothing was complete.
    pub objective: Option<f64>,
    /// How many evaluations it took.
    pub evaluations: u64,
}

impl Tried {
    /// The response: log10 of the best objective, which makes factors add up and seeds scatter alike.
    pub fn response(&self) -> Option<f64> {
        let positive = self.objective.filter(|objective| *objective > 0.0);
        positive.map(f64::log10)
    }
}

/// What the runs of a design say.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// Of every factor.
    pub ranges: Vec<Range>,
    /// None where the design is saturated.
    pub anova: Option<Anova>,
    /// The response to expect at the best levels.
    pub predicted: f64,
}

impl Analysis {
    /// Of the runs of a design; `seeds` are its blocks. None where one of them has no response.
    pub fn of(array: Array, factors: usize, seeds: &[u64], runs: &[Tried]) -> Option<Self> {
        let observe = |run: &Tried| {
            Some(Observation {
                levels: run.levels.clone(),
                block: seeds.iter().position(|seed| *seed == run.seed)?,
                response: run.response()?,
            })
        };
        let observations: Vec<Observation> = runs.iter().map(observe).collect::<Option<_>>()?;
        let ranges = ranges(&observations, array.levels(), factors);
        Some(Self {
            anova: anova(&observations, array.levels(), factors, seeds.len()),
            predicted: predicted(&observations, &ranges),
            ranges,
        })
    }

    /// The best level of every factor.
    pub fn best(&self) -> Vec<usize> {
        self.ranges.iter().map(|range| range.best).collect()
    }
}

/// The best levels together, tried with seeds of their own.
#[derive(Clone, Debug, PartialEq)]
pub struct Confirmation {
    /// The best level of every factor.
    pub levels: Vec<usize>,
    /// The response that was expected.
    pub predicted: f64,
    /// What came out.
    pub runs: Vec<Tried>,
}

impl Confirmation {
    /// Mean response; none where a run has none.
    pub fn obtained(&self) -> Option<f64> {
        let responses: Option<Vec<f64>> = self.runs.iter().map(Tried::response).collect();
        let responses = responses.filter(|all| !all.is_empty())?;
        Some(responses.iter().sum::<f64>() / responses.len() as f64)
    }
}

/// A whole test.
#[derive(Clone, Debug, PartialEq)]
pub struct Tested {
    /// Its array.
    pub array: Array,
    /// Its factors.
    pub factors: Vec<Factor>,
    /// Its runs, row by row, each with every seed.
    pub runs: Vec<Tried>,
    /// What they say; none where one of them found nothing complete.
    pub analysis: Option<Analysis>,
    /// The best levels together; none without an analysis.
    pub confirmation: Option<Confirmation>,
}

impl Tested {
    /// Whether runs took different numbers of evaluations, so that a level may be better only because it was
    /// given more.
    pub fn budgets_differ(&self) -> bool {
        let mut evaluations = self.runs.iter().map(|run| run.evaluations);
        let first = evaluations.next();
        evaluations.any(|other| Some(other) != first)
    }
}
