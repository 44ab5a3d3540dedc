//! `horsehead report`: the files of a finished run again, from its journal.
use super::{
    Door, EXIT_CODES, OutputChoice, bus, diagnose,
    finish::{self, Session},
    interrupt,
    progress::Silent,
    run_folder::{CALIBRATE, DIAGNOSE, RunFolder},
};
use clap::Args;
use std::{path::PathBuf, time::Instant};

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

/// Replays the run and writes its files.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    if RunFolder::kind(&arguments.run).as_deref() == Some(DIAGNOSE) {
        return diagnose::again(&arguments.run, arguments.output.output);
    }
    let (folder, manifest, case) =
        RunFolder::open::<search::strategy::Settings>(&arguments.run, CALIBRATE)?;
    folder.expect_replayable(&manifest)?;
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
