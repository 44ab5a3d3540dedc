//! `horsehead report`: writes the files of a finished run again, from its journal.
use crate::cli::{
    argument::output::OutputChoice,
    output::{calibration::show, problem::EXIT_CODES, progress::Silent},
    run::{bus, folder::RunFolder, interrupt, kind::AnyRun},
};
use clap::Args;
use journal::event::Finished;
use protocol::job::Job;
use std::path::PathBuf;
use study::ReplayEvaluator;

/// Write tables, figures and report of a finished run again, from its journal.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Example:
  horsehead report runs/cyjs10-5-37hb-quick-seed1
  horsehead report runs/cyjs10-5-37hb-diagnose-seed1

Nothing is simulated: an unfinished run is refused.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Run folder of a calibration or a diagnosis.
    #[arg(value_name = "RUN", env = "HORSEHEAD_RUN")]
    run: PathBuf,
    #[command(flatten)]
    output: OutputChoice,
}

/// Replays the run from its journal and writes its report files.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let run = AnyRun::open(&arguments.run)?;
    if let AnyRun::Calibration(run) = &run {
        return show(run, run.manifest.wall_s, arguments.output.output);
    }
    run.check_replayable()?;
    let recording = RunFolder::new(&arguments.run).recording()?;
    let mut unseen = |_: &Job, _: &Finished| Ok(());
    let mut recorded = ReplayEvaluator::new(&recording, &mut unseen);
    let repeated = bus::block_on(async {
        let mut stop = interrupt::listen();
        run.replay(&mut recorded, &mut Silent, &mut stop).await
    })?;
    repeated.write(arguments.output.output)
}
