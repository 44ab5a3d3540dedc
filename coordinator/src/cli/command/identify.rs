//! `horsehead identify`: finds which unknowns the measured records determine, individually and jointly, and
//! which remain undetermined.
use crate::cli::{
    argument::{case::case_folder, output::OutputChoice, workers::WorkersChoice},
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
    target::StudyTarget,
};
use std::path::PathBuf;

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
    /// Case folder, or the folder of a finished calibration.
    #[arg(value_name = "CASE|RUN", value_parser = case_folder)]
    target: PathBuf,
    /// Folder whose inputs and records replace those of the case: a new test of the
    /// same machine.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_MEASURED")]
    measured: Option<PathBuf>,
    /// Gene file to start the fit from, such as a run's `calibrated.toml`.
    #[arg(long, value_name = "FILE", env = "HORSEHEAD_GENES")]
    genes: Option<PathBuf>,
    /// Take every derivative as a difference of whole simulations, as if the model gave none: slower.
    #[arg(long, env = "HORSEHEAD_DIFFERENCES")]
    differences: bool,
    /// Fixes every random choice: the same seed gives the same bits [default: that of the calibration, or 1].
    #[arg(long, env = "HORSEHEAD_SEED")]
    seed: Option<u64>,
    /// Run folder [default: runs/CASE-identify-seedN, with what distinguishes the calibration, --genes, the effects of the
    /// case and --measured].
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_RUN")]
    run: Option<PathBuf>,
    #[command(flatten)]
    output: OutputChoice,
    #[command(flatten)]
    workers: WorkersChoice,
}

/// Runs the identifiability analysis from the measured records to the report.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let session = Session::begin();
    let target = StudyTarget::read(
        &arguments.target,
        arguments.measured.as_deref(),
        arguments.genes.as_deref(),
    )?;
    let seed = target.seed(arguments.seed);
    let path = match &arguments.run {
        Some(path) => path.clone(),
        None => target.run_path(IDENTIFY, seed)?,
    };
    message::print_notes(&target.loaded.notes);
    let settings = IdentificationSettings {
        orders: Thresholds::default().orders,
        differences: arguments.differences,
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
