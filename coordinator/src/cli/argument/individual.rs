//! Arguments that select the parameter values to simulate and the working condition.
use clap::Args;
use protocol::case::Case;
use std::path::Path;
use support::Problem;

/// Parameters to simulate, and the working condition.
#[derive(Clone, Debug, Args)]
pub(crate) struct IndividualChoice {
    /// Parameters: `recommended`, or a gene file such as a run's `calibrated.toml`.
    #[arg(
        long,
        value_name = "recommended|FILE",
        default_value = "recommended",
        env = "HORSEHEAD_GENES"
    )]
    pub(crate) genes: String,
    /// Working condition; that of the case's objective by default.
    #[arg(long, value_name = "NAME", env = "HORSEHEAD_CONDITION")]
    pub(crate) condition: Option<String>,
}

impl IndividualChoice {
    /// Returns the path of the gene file; `None` for the recommended values.
    pub(crate) fn file(&self) -> Option<&Path> {
        (self.genes != "recommended").then(|| Path::new(&self.genes))
    }

    /// Returns the index of the chosen working condition in the case.
    pub(crate) fn condition(&self, case: &Case) -> Result<usize, Problem> {
        condition(case, self.condition.as_deref())
    }
}

/// Returns the index of the named working condition in the case; without a name, that of the condition that
/// the objective uses.
pub(crate) fn condition(case: &Case, name: Option<&str>) -> Result<usize, Problem> {
    let Some(name) = name else {
        return Ok(case.objective.condition);
    };
    case.condition(name).ok_or_else(|| {
        let known: Vec<&str> = case.conditions.iter().map(|c| c.name.as_str()).collect();
        Problem {
            message: format!("the case has no condition `{name}`"),
            remedy: format!("it has: {}", known.join(", ")),
        }
    })
}
