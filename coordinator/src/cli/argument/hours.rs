//! Argument that states how many hours a day the machine runs under each condition.
use super::individual::condition;
use clap::Args;
use protocol::case::Case;
use support::Problem;

/// Hours a day under each condition.
#[derive(Clone, Debug, Args)]
pub(crate) struct HoursChoice {
    /// Hours a day under each condition, as 5rpm=16,4rpm=8 [default: 24 under that of the objective].
    #[arg(
        long,
        value_name = "NAME=H,..",
        value_delimiter = ',',
        env = "HORSEHEAD_HOURS"
    )]
    hours: Vec<String>,
}

/// Operation under one condition.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Operation {
    /// Index of the condition in the case.
    pub(crate) condition: usize,
    pub(crate) name: String,
    pub(crate) hours_per_day: f64,
    pub(crate) revolutions_per_day: f64,
}

impl HoursChoice {
    /// Returns the operation under each stated condition; `speed_rpm` gives the revolutions per minute under a condition.
    ///
    /// # Errors
    /// If a condition is unknown or stated twice, a number of hours is none, or a day has more than 24.
    pub(crate) fn operations(
        &self,
        case: &Case,
        speed_rpm: impl Fn(usize) -> f64,
    ) -> Result<Vec<Operation>, Problem> {
        let operation = |condition: usize, hours_per_day: f64| Operation {
            condition,
            name: case.conditions[condition].name.clone(),
            hours_per_day,
            revolutions_per_day: 60.0 * hours_per_day * speed_rpm(condition),
        };
        let problem = |message: String, remedy: &str| Problem {
            message,
            remedy: remedy.to_owned(),
        };
        if self.hours.is_empty() {
            return Ok(vec![operation(case.objective.condition, 24.0)]);
        }
        let mut operations: Vec<Operation> = Vec::new();
        for word in &self.hours {
            let typed = word
                .split_once('=')
                .and_then(|(name, hours)| Some((name.trim(), hours.trim().parse::<f64>().ok()?)));
            let Some((name, hours)) = typed.filter(|(_, hours)| hours.is_finite() && *hours > 0.0)
            else {
                return Err(problem(
                    format!("--hours: `{word}` is no condition with its hours a day"),
                    "write NAME=HOURS, as in --hours 5rpm=16,4rpm=8",
                ));
            };
            let condition = condition(case, Some(name))?;
            if operations.iter().any(|own| own.condition == condition) {
                return Err(problem(
                    format!("--hours states {name} twice"),
                    "state each condition once",
                ));
            }
            operations.push(operation(condition, hours));
        }
        let total: f64 = operations.iter().map(|own| own.hours_per_day).sum();
        if total > 24.0 + 1e-9 {
            return Err(problem(
                format!("--hours adds up to {total} hours a day"),
                "a day has 24; hours that are left are standstill",
            ));
        }
        Ok(operations)
    }
}
