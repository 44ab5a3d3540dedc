//! JSON objects of `horsehead sweep orthogonal` and of a sweep of a grid.
use serde::Serialize;
use serde_json::{Map, Value};
use study::orthogonal::{Anova, Confirmation, Factor, TestResult, TrialRun, VarianceSource};

/// JSON object printed by `horsehead sweep orthogonal`, also written as `result.json` in the run folder.
/// Responses are log10 of the best objective, in the objective's unit.
#[derive(Debug, Serialize)]
pub(crate) struct OrthogonalOutput {
    /// Name of the orthogonal array: `L9`, `L16` or `L25`.
    array: &'static str,
    factors: Vec<FactorOutput>,
    /// Results of the searches, for each row of the orthogonal array and each seed.
    runs: Vec<SearchOutput>,
    /// Range analysis of the responses, one element per factor; null if a search found no complete
    /// individual.
    ranges: Option<Vec<RangeOutput>>,
    /// Analysis of variance of the responses; null if a search found no complete individual or the design is
    /// saturated.
    anova: Option<Vec<TermOutput>>,
    confirmation: Option<ConfirmationOutput>,
}

#[derive(Debug, Serialize)]
struct FactorOutput {
    name: String,
    levels: Vec<Value>,
}

/// Result of a search with one combination of factor levels and one seed.
#[derive(Debug, Serialize)]
struct SearchOutput {
    /// Level of each factor in this search, by factor name.
    levels: Map<String, Value>,
    seed: u64,
    /// Best objective of the search; null if no individual completed its simulation.
    objective: Option<f64>,
    evaluations: u64,
}

#[derive(Debug, Serialize)]
struct RangeOutput {
    factor: String,
    /// Mean of the responses at each level of the factor.
    means: Vec<f64>,
    range: f64,
    best: Value,
}

#[derive(Debug, Serialize)]
struct TermOutput {
    /// Source of variation in the analysis of variance: a factor's name, `seed` or `error`.
    source: String,
    sum_of_squares: f64,
    freedom: usize,
    mean_square: f64,
    f: Option<f64>,
    p: Option<f64>,
}

#[derive(Debug, Serialize)]
struct ConfirmationOutput {
    levels: Map<String, Value>,
    predicted: f64,
    /// Mean response of the confirmation runs, for comparison with the predicted one; null if there is none.
    obtained: Option<f64>,
    runs: Vec<SearchOutput>,
}

impl From<&TestResult> for OrthogonalOutput {
    fn from(tested: &TestResult) -> Self {
        let factors = &tested.factors;
        let analysis = tested.analysis.as_ref();
        let ranges = analysis.map(|analysis| {
            let ranges = factors.iter().zip(&analysis.ranges);
            let one = ranges.map(|(factor, range)| RangeOutput {
                factor: factor.name.clone(),
                means: range.means.clone(),
                range: range.range,
                best: value(&factor.levels[range.best]),
            });
            one.collect()
        });
        let confirmation = tested.confirmation.as_ref().map(|own| ConfirmationOutput {
            levels: levels(factors, &own.levels),
            predicted: own.predicted,
            obtained: Confirmation::obtained(own),
            runs: tried(factors, &own.runs),
        });
        Self {
            array: tested.array.name(),
            factors: listed(factors),
            runs: tried(factors, &tested.runs),
            ranges,
            anova: analysis.and_then(|own| Some(terms(factors, own.anova.as_ref()?))),
            confirmation,
        }
    }
}

/// JSON object printed by `horsehead sweep FILE.toml`, also written as `result.json` in the run folder.
#[derive(Debug, Serialize)]
pub(crate) struct GridOutput {
    factors: Vec<FactorOutput>,
    /// Results of the searches: for every combination of levels, last factor varying fastest, and every seed.
    runs: Vec<SearchOutput>,
}

impl GridOutput {
    pub(crate) fn new(factors: &[Factor], runs: &[TrialRun]) -> Self {
        Self {
            factors: listed(factors),
            runs: tried(factors, runs),
        }
    }
}

/// Formats the results of searches as a CSV table: a column per factor, `seed`, `objective` (empty if no
/// individual was complete), `evaluations`.
///
/// # Errors
/// If a row cannot be written.
pub(crate) fn runs_table(factors: &[Factor], runs: &[TrialRun]) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let names = factors.iter().map(|factor| factor.name.as_str());
    writer.write_record(names.chain(["seed", "objective", "evaluations"]))?;
    for run in runs {
        let levels = factors.iter().zip(&run.levels);
        let levels = levels.map(|(factor, level)| factor.levels[*level].clone());
        let objective = run.objective.map_or_else(String::new, |it| it.to_string());
        let numbers = [run.seed.to_string(), objective, run.evaluations.to_string()];
        writer.write_record(levels.chain(numbers))?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

fn listed(factors: &[Factor]) -> Vec<FactorOutput> {
    let one = |factor: &Factor| FactorOutput {
        name: factor.name.clone(),
        levels: factor.levels.iter().map(|level| value(level)).collect(),
    };
    factors.iter().map(one).collect()
}

fn terms(factors: &[Factor], anova: &Anova) -> Vec<TermOutput> {
    let one = |term: &study::orthogonal::AnovaTerm| TermOutput {
        source: match term.source {
            VarianceSource::Factor(number) => factors[number].name.clone(),
            VarianceSource::Block => "seed".to_owned(),
            VarianceSource::Error => "error".to_owned(),
        },
        sum_of_squares: term.squares,
        freedom: term.freedom,
        mean_square: term.mean_square(),
        f: term.f,
        p: term.p,
    };
    anova.terms.iter().map(one).collect()
}

/// Converts the results of searches to their JSON form, with levels by factor name.
fn tried(factors: &[Factor], runs: &[TrialRun]) -> Vec<SearchOutput> {
    let one = |run: &TrialRun| SearchOutput {
        levels: levels(factors, &run.levels),
        seed: run.seed,
        objective: run.objective,
        evaluations: run.evaluations,
    };
    runs.iter().map(one).collect()
}

fn levels(factors: &[Factor], row: &[usize]) -> Map<String, Value> {
    let one =
        |(factor, level): (&Factor, &usize)| (factor.name.clone(), value(&factor.levels[*level]));
    factors.iter().zip(row).map(one).collect()
}

/// Converts a factor level from text to a JSON number or boolean if it is one, else to a string.
fn value(words: &str) -> Value {
    let plain = serde_json::from_str(words).ok();
    plain
        .filter(|value: &Value| value.is_number() || value.is_boolean())
        .unwrap_or_else(|| words.into())
}
