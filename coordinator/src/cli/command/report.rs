//! `horsehead report`: writes the files of a finished run again, from its journal.
use crate::cli::{argument::output::OutputChoice, output::problem::EXIT_CODES, run::kind::AnyRun};
use clap::Args;
use std::path::PathBuf;

/// Write tables, figures and report of a finished run again, from its journal.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Example:
  horsehead report runs/cyjs10-5-37hb-quick-seed1
  horsehead report runs/cyjs10-5-37hb-diagnose-seed1

Nothing is simulated, and neither the case folder nor a worker is needed; an unfinished run is
refused.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Run folder.
    #[arg(value_name = "RUN", env = "HORSEHEAD_RUN")]
    run: PathBuf,
    #[command(flatten)]
    output: OutputChoice,
}

/// Reads the result of the run from its journal and writes its report files.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    AnyRun::open(&arguments.run)?.show(arguments.output.output)
}
