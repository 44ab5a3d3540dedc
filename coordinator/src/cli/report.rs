//! `horsehead report`: the files of a finished run again, from its journal.
use super::{
    Door, EXIT_CODES, OutputChoice, bus,
    finish::{self, Session},
    interrupt,
    problem::Usage,
    progress::Silent,
    run_folder::{self, RunFolder},
};
use clap::Args;
use std::{path::PathBuf, time::Instant};

/// Write tables, figures and report of a finished run again, from its journal.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Example:
  horsehead report runs/cyjs10-5-37hb-quick-seed1

Nothing is simulated: an unfinished run is refused.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Run folder of a calibration.
    #[arg(value_name = "RUN", env = "HORSEHEAD_RUN")]
    run: PathBuf,
    #[command(flatten)]
    output: OutputChoice,
}

/// Replays the run and writes its files.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let (folder, manifest, case) =
        RunFolder::open::<search::strategy::Settings>(&arguments.run, run_folder::CALIBRATE)?;
    if !folder.is_finished() {
        return Err(Usage {
            message: format!("{} is not finished", arguments.run.display()),
            help: format!(
                "go on with it first:\n  {}",
                manifest.resume_command(&arguments.run)
            ),
        }
        .into());
    }
    if !folder.has_journal() {
        return Err(Usage {
            message: format!(
                "the journal of {} is gone or empty",
                arguments.run.display()
            ),
            help: format!(
                "put it back, or compute the run anew:\n  {}",
                manifest.resume_command(&arguments.run)
            ),
        }
        .into());
    }
    let session = Session {
        folder: &folder,
        manifest: &manifest,
        case: &case,
        earlier_s: manifest.wall_s,
        started: Instant::now(),
        door: Door::default(),
        local_workers: 0,
        resumed: true,
        replay: true,
    };
    let found = bus::block_on(async {
        let mut stop = interrupt::listen();
        session.run(&mut Silent, &mut stop).await
    })?;
    finish::show(&session, &found, arguments.output.output)
}
