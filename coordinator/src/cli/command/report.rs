//! `horsehead report`: writes the files of a finished run again, from its journal.
use crate::cli::{
    argument::output::OutputChoice,
    output::{calibration, diagnosis::DiagnosisOutput, identification, problem::EXIT_CODES, sweep},
};
use clap::Args;
use run::view::AnyRun;
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
    let output = arguments.output.output;
    match AnyRun::open(&arguments.run)? {
        AnyRun::Calibration(run) => calibration::show(&run, run.manifest.wall_s, output),
        AnyRun::Diagnosis(run) => {
            let answer = DiagnosisOutput::read(&run, run.manifest.wall_s)?;
            let object = answer.write()?;
            answer.print(output, &object)
        }
        AnyRun::Identification(run) => identification::show(&run, run.manifest.wall_s, output),
        AnyRun::Test(run) => sweep::show_test(&run, output),
        AnyRun::Sweep(run) => sweep::show_file(&run, output),
    }
}
