//! Division of simulations with derivatives into parts with some of their columns.
use dispatch::runtime::Divide;
use protocol::{
    case::Case,
    external::{External, OutputFormat},
    job::{Job, Outcome, division},
};

/// Division of simulations with derivatives by columns.
///
/// A simulation with derivatives takes several times as long as a plain one, and a descent waits for it. Each part repeats
/// the simulation with some of the columns. A part with `n` columns costs as much as `1 + 0.44 n` plain simulations of the
/// pumping unit (12 columns cost 6.3), so that even two parts halve the wait, at 1.16 times the work, of slots that
/// would do none.
#[derive(Clone, Copy, Debug)]
pub struct ColumnDivision {
    /// Whether one run of the model gives all columns, so that parts would only repeat it.
    has_gradients: bool,
}

impl ColumnDivision {
    /// Creates the division of simulations of a case. Those of a program that returns gradients stay whole.
    pub fn of(case: &Case) -> Self {
        let outputs = External::of(&case.model).map(|external| external.readings);
        let gives = |form: &OutputFormat| match form {
            OutputFormat::Dakota { gradients, .. } => *gradients,
            OutputFormat::Pest(_) | OutputFormat::Table | OutputFormat::Object => false,
        };
        let has_gradients = outputs.is_ok_and(|all| all.iter().any(|file| gives(&file.form)));
        Self { has_gradients }
    }
}

impl Divide for ColumnDivision {
    fn units(&self, job: &Job) -> usize {
        if self.has_gradients {
            0
        } else {
            division::shared_columns(job)
        }
    }

    fn split(&self, job: Job, size: usize) -> Vec<Job> {
        division::split(job, size)
    }

    fn join(&self, joined: Outcome, next: Outcome) -> Outcome {
        division::join(joined, next)
    }

    fn least_parts(&self, units: usize) -> usize {
        least_parts(units)
    }
}

/// Returns the smallest number of parts in which an anticipated simulation with a number of columns is worth its slots:
/// parts of two columns, which end before the same simulation would if it was begun, in parts of one column, after the
/// simulations that are running now (1.9 plain simulations against 1 + 1.4).
pub const fn least_parts(columns: usize) -> usize {
    if columns == 0 { 1 } else { columns.div_ceil(2) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::{
        external::{OutputFile, kind_of},
        job::{Column, Individual, Reply, SimulateSpec},
        wire,
    };

    fn program(gradients: bool) -> Case {
        let reading = OutputFile {
            file: "results.out".to_owned(),
            form: OutputFormat::Dakota {
                functions: vec!["f".to_owned()],
                gradients,
            },
        };
        let external = External {
            files: Vec::new(),
            fills: Vec::new(),
            readings: vec![reading],
            equations: Vec::new(),
            parameters: Vec::new(),
            conditions: Vec::new(),
            curves: Vec::new(),
            verdicts: Vec::new(),
        };
        let mut case = Case::default();
        case.model.kind = kind_of("driver");
        case.model.settings = wire::encode(&external).unwrap();
        case
    }

    #[test]
    fn jobs_of_a_program_that_returns_gradients_stay_whole() {
        let job = Job::Simulate(SimulateSpec {
            columns: ["a", "b", "c"]
                .map(|name| Column::new(name.to_owned()))
                .to_vec(),
            ..SimulateSpec::new(Individual::new(0, vec![1.0; 3]), Reply::Channels)
        });
        let units = |case: &Case| ColumnDivision::of(case).units(&job);
        assert_eq!(units(&Case::default()), 3);
        assert_eq!(units(&program(false)), 3);
        assert_eq!(units(&program(true)), 0);
    }
}
