//! `horsehead sweep`: runs many searches, or scores many individuals, in one resumable run.
mod file;
mod grid;
mod orthogonal;
mod scaling;

use crate::cli::output::problem::EXIT_CODES;
use clap::{Args, Subcommand};

/// Compare settings of a search, or score a table of individuals; the same command resumes.
#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = format!("\
A grid runs every combination of its values with every seed:
  case = \"../cases/cyjs10-5-37hb\"     # as seen from the file; or --case
  preset = \"paper\"
  seeds = [1, 2, 3]
  evaluations = 1000
  [set]                               # settings that all share
  encoding = \"gray\"
  [grid]
  population = [40, 80]
  mutation_probability = [0.02, 0.05]
A table of individuals has a column for each unknown that the case searches; what comes out has
its columns, the objective, the verdict and every channel's scores.

Examples:
  horsehead sweep grid.toml
  horsehead sweep individuals.csv --case cases/cyjs10-5-37hb --output json
  horsehead sweep orthogonal cases/cyjs10-5-37hb
  horsehead sweep scaling cases/cyjs10-5-37hb

{EXIT_CODES}")
)]
pub(super) struct Arguments {
    #[command(subcommand)]
    kind: Option<Kind>,
    #[command(flatten)]
    file: file::FileArguments,
}

#[derive(Debug, Subcommand)]
enum Kind {
    Orthogonal(orthogonal::Arguments),
    Scaling(scaling::Arguments),
}

/// Runs the selected sweep: a file, an orthogonal array or a scaling study.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.kind {
        Some(Kind::Orthogonal(arguments)) => orthogonal::run(arguments),
        Some(Kind::Scaling(arguments)) => scaling::run(arguments),
        None => file::run(&arguments.file),
    }
}
