//! `horsehead identify`: finds which unknowns the measured records determine, individually and jointly, and
//! which remain undetermined.
use crate::cli::{
    argument::{output::OutputChoice, study::StudyArguments, workers::WorkersChoice},
    output::{identification::show, problem::EXIT_CODES, progress::StageDisplay},
};
use clap::Args;
use discrepancy::thresholds::Thresholds;
use run::{
    identification::{IdentificationSettings, identify},
    manifest::IDENTIFY,
    message,
    opened::Run,
    session::Session,
};

/// Say which unknowns a record determines, how well, which trade off, and what that does to predictions.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead identify cases/cyjs10-5-37hb
  horsehead identify runs/cyjs10-5-37hb-quick-seed1
  horsehead identify cases/cyjs10-5-37hb --measured tests/of/march --output json

A case is fitted first; a finished run of `calibrate`, or a gene file, gives the start. Every
unknown gets a 95 % interval, a bound on one side, or \"not determined by this record\": the
likelihood profile, with all other unknowns refitted, does not rise by 3.84 within its bounds.
Where the fit leaves more than noise, intervals are widened accordingly; run `diagnose` next.
Ctrl-C stops cleanly: results so far are kept, and the same command goes on.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    output: OutputChoice,
    #[command(flatten)]
    workers: WorkersChoice,
}

/// Runs the identifiability analysis from the measured records to the report.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let session = Session::begin();
    let target = arguments.study.read()?;
    let seed = target.seed(arguments.study.seed);
    let path = match &arguments.study.run {
        Some(path) => path.clone(),
        None => target.run_path(IDENTIFY, seed)?,
    };
    message::print_notes(&target.loaded.notes);
    let settings = IdentificationSettings {
        orders: Thresholds::default().orders,
        differences: arguments.study.differences,
    };
    let manifest = target.manifest(seed, settings)?;
    let run = Run::begin(&path, manifest, target.loaded.case.clone())?;
    session.work(
        &run,
        &arguments.workers.session()?,
        async |dispatch, stop| {
            let mut display = StageDisplay::new();
            let found = identify(dispatch, &run.manifest, &target.loaded, &mut display, stop).await;
            display.clear();
            found
        },
    )?;
    show(&run, session.wall_s(&run), arguments.output.output)
}
