//! `horsehead report`: writes the files of a finished run again, from its journal.
use super::sweep;
use crate::cli::{
    argument::output::OutputChoice,
    output::problem::EXIT_CODES,
    run::{
        folder::RunFolder, kind::AnyRun, manifest::RunIdentity as _, opened::Run,
        orthogonal::Orthogonal, sweep_file::SweptFile,
    },
};
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
    let (path, output) = (&arguments.run, arguments.output.output);
    match RunFolder::at(path)?.head()?.kind.as_str() {
        Orthogonal::KIND => sweep::orthogonal::show(&Run::open(path)?, output),
        SweptFile::KIND => sweep::file::show(&Run::open(path)?, output),
        _ => AnyRun::open(path)?.show(output),
    }
}
