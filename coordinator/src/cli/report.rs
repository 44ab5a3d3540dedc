//! `horsehead report`: the files of a finished run again, from its journal.
use super::{
    Door, EXIT_CODES, OutputChoice, bus, diagnosed,
    finish::{self, Session},
    interrupt, output,
    progress::Silent,
    run_folder::{CALIBRATE, DIAGNOSE, RunFolder},
};
use crate::{
    journal::{self, Recording},
    study::Recorded,
};
use clap::Args;
use protocol::{event::Finished, job::Job};
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
        return diagnosed::report(&arguments.run, arguments.output.output);
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
    };
    let recording = recording(&folder)?;
    let mut unseen = |_: &Job, _: &Finished| Ok(());
    let mut recorded = Recorded::new(&recording, &mut unseen);
    let found = bus::block_on(async {
        let mut stop = interrupt::listen();
        finish::repeat(&mut recorded, (&case, &manifest), &mut Silent, &mut stop).await
    })?;
    finish::show(&session, &found, arguments.output.output)
}

/// The journal of a run, for reading alone; what of it is damaged goes to standard error.
pub(super) fn recording(folder: &RunFolder) -> anyhow::Result<Recording> {
    let recording = Recording::read(&folder.file(journal::FILE), |_, _| {})?;
    for damage in journal::words(&recording.report().damage) {
        output::tell(&format!("warning: {damage}"));
    }
    Ok(recording)
}
