//! Complete orthogonal test of search settings: runs, their analysis, and the confirmation of the best
//! levels.
use super::{
    anova::{Anova, anova},
    array::Array,
    range::{Range, Response, predicted, ranges},
};
use serde::{Deserialize, Serialize};

/// Factor of an orthogonal test, i.e. a search setting, with the levels that are compared.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Factor {
    /// Name of the factor.
    pub name: String,
    /// Values of the factor at its levels, as text.
    pub levels: Vec<String>,
}

impl Factor {
    /// Creates a factor from its name and the texts of its levels.
    pub fn new(name: &str, levels: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self {
            name: name.to_owned(),
            levels: levels.into_iter().map(Into::into).collect(),
        }
    }
}

/// Run of a design: the result of one search with given factor levels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrialRun {
    /// Index of each factor's level in the run, from 0.
    pub levels: Vec<usize>,
    /// Seed of the run's search; runs with the same seed form a block.
    pub seed: u64,
    /// Best objective found by the run's search, in the objective's unit; none where no simulation was
    /// complete.
    pub objective: Option<f64>,
    /// Number of simulations that the run's search evaluated.
    pub evaluations: u64,
}

impl TrialRun {
    /// Returns the response: log10 of the best objective, which makes the effects of factors additive and the
    /// variance between seeds uniform.
    pub fn response(&self) -> Option<f64> {
        let positive = self.objective.filter(|objective| *objective > 0.0);
        positive.map(f64::log10)
    }
}

/// Statistical analysis of the runs of an orthogonal test.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Analysis {
    /// Range analysis of every factor: mean response per level and their spread.
    pub ranges: Vec<Range>,
    /// Analysis of variance table; none where the design is saturated.
    pub anova: Option<Anova>,
    /// Predicted response at the best level of every factor (log10 of the objective).
    pub predicted: f64,
}

impl Analysis {
    /// Analyses the runs of a design with `seeds` as blocks. Returns none if a run has no response.
    pub fn of(array: Array, factors: usize, seeds: &[u64], runs: &[TrialRun]) -> Option<Self> {
        let observe = |run: &TrialRun| {
            Some(Response {
                levels: run.levels.clone(),
                block: seeds.iter().position(|seed| *seed == run.seed)?,
                response: run.response()?,
            })
        };
        let observations: Vec<Response> = runs.iter().map(observe).collect::<Option<_>>()?;
        let ranges = ranges(&observations, array.levels(), factors);
        Some(Self {
            anova: anova(&observations, array.levels(), factors, seeds.len()),
            predicted: predicted(&observations, &ranges),
            ranges,
        })
    }

    /// Returns the index of the best level of every factor.
    pub fn best(&self) -> Vec<usize> {
        self.ranges.iter().map(|range| range.best).collect()
    }
}

/// Confirmation of an orthogonal test: runs at the best levels with new seeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Confirmation {
    /// Index of the best level of every factor.
    pub levels: Vec<usize>,
    /// Response predicted at the best levels (log10 of the objective).
    pub predicted: f64,
    /// Confirmation runs at the best levels, one per new seed.
    pub runs: Vec<TrialRun>,
}

impl Confirmation {
    /// Returns the mean response of the confirmation runs (log10 of the objective); none if a run found no
    /// complete simulation.
    pub fn obtained(&self) -> Option<f64> {
        let responses: Option<Vec<f64>> = self.runs.iter().map(TrialRun::response).collect();
        let responses = responses.filter(|all| !all.is_empty())?;
        Some(responses.iter().sum::<f64>() / responses.len() as f64)
    }
}

/// Orthogonal test with its design, runs, analysis and confirmation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TestResult {
    /// Orthogonal array that defines the runs of the test.
    pub array: Array,
    /// Factors (search settings) that the test compares, with their levels.
    pub factors: Vec<Factor>,
    /// Runs of the test, in the order of the array's rows, each row with every seed.
    pub runs: Vec<TrialRun>,
    /// Analysis of the runs; none if a run has no complete simulation.
    pub analysis: Option<Analysis>,
    /// Confirmation of the best levels; none without an analysis.
    pub confirmation: Option<Confirmation>,
}

impl TestResult {
    /// Returns whether runs took different numbers of evaluations, in which case a level may be better only
    /// because of a larger budget.
    pub fn budgets_differ(&self) -> bool {
        let mut evaluations = self.runs.iter().map(|run| run.evaluations);
        let first = evaluations.next();
        evaluations.any(|other| Some(other) != first)
    }
}
