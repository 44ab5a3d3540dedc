//! `horsehead diagnose`: where simulation and measured records differ, which missing effect explains the
//! difference, how certain that is, and how far the gap closes.
use crate::cli::{
    argument::{case::case_folder, output::OutputChoice, workers::WorkersChoice},
    output::{diagnosis::DiagnosisOutput, problem::EXIT_CODES, progress::StageDisplay},
};
use clap::Args;
use discrepancy::thresholds::Thresholds;
use run::{
    diagnosis::{DiagnosisRun, DiagnosisSettings, diagnose},
    manifest::DIAGNOSE,
    message,
    opened::Run,
    session::Session,
    target::StudyTarget,
};
use std::path::PathBuf;

/// Find what the simulation is missing: where, which effect, how large, and the proof.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead diagnose cases/cyjs10-5-37hb
  horsehead diagnose runs/cyjs10-5-37hb-quick-seed1
  horsehead diagnose cases/cyjs10-5-37hb --measured tests/of/march --output json

A case is recalibrated from scratch; a finished run of `calibrate` gives its parameters as the
start. What is found is written into effects.toml of the run folder, in the form that case.toml
takes; --add appends it to the case itself, and from then on it is ordinary physics. Ctrl-C
stops cleanly: results so far are kept, and the same command goes on.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Case folder, or the folder of a finished calibration.
    #[arg(value_name = "CASE|RUN", value_parser = case_folder)]
    target: PathBuf,
    /// Folder whose inputs and records replace those of the case: a new test of the
    /// same machine.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_MEASURED")]
    measured: Option<PathBuf>,
    /// Gene file to start the recalibration from, such as a run's `calibrated.toml`.
    #[arg(long, value_name = "FILE", env = "HORSEHEAD_GENES")]
    genes: Option<PathBuf>,
    /// Effect that is not to be considered; may be given several times, or with commas.
    #[arg(
        long,
        value_name = "EFFECT",
        value_delimiter = ',',
        env = "HORSEHEAD_WITHOUT"
    )]
    without: Vec<String>,
    /// Effects that are added at most.
    #[arg(long, default_value_t = 3, value_name = "N", env = "HORSEHEAD_ROUNDS", value_parser = clap::value_parser!(u8).range(1..=5))]
    rounds: u8,
    /// Take every derivative as a difference of whole simulations, as if the model gave none: slower, and a
    /// check of the exact derivatives.
    #[arg(long, env = "HORSEHEAD_DIFFERENCES")]
    differences: bool,
    /// Append what is found to the case's case.toml.
    #[arg(long, env = "HORSEHEAD_ADD")]
    add: bool,
    /// Fixes every random choice: the same seed gives the same bits [default: that of the calibration, or 1].
    #[arg(long, env = "HORSEHEAD_SEED")]
    seed: Option<u64>,
    /// Run folder [default: runs/CASE-diagnose-seedN, with what distinguishes the calibration, --genes, the effects of the
    /// case and --measured].
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_RUN")]
    run: Option<PathBuf>,
    #[command(flatten)]
    output: OutputChoice,
    #[command(flatten)]
    workers: WorkersChoice,
}

/// Runs the diagnosis from the measured records to the report.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let session = Session::begin();
    let mut target = StudyTarget::read(
        &arguments.target,
        arguments.measured.as_deref(),
        arguments.genes.as_deref(),
    )?;
    let seed = target.seed(arguments.seed);
    let settings = DiagnosisSettings {
        thresholds: Thresholds {
            rounds: usize::from(arguments.rounds),
            simulations: target.loaded.diagnose.simulations,
            without: arguments.without.clone(),
            ..Thresholds::default()
        },
        differences: arguments.differences,
    };
    let path = match &arguments.run {
        Some(path) => path.clone(),
        // after --add the case has what the run found
        None => match target.earlier_path(seed, &settings)? {
            Some(earlier) => earlier,
            None => target.run_path(DIAGNOSE, seed)?,
        },
    };
    let stated = target.loaded.effects.len();
    if let Ok(earlier) = DiagnosisRun::open(&path) {
        target = target.without_additions_of(&earlier)?;
    }
    let has_own = target.loaded.effects.len() < stated;
    message::print_notes(&target.loaded.notes);
    let manifest = target.manifest(seed, settings)?;
    let run = Run::begin(&path, manifest, target.loaded.case.clone())?;
    let answer = if let Some(answer) = DiagnosisOutput::read_complete(&run) {
        let path = run.folder.path().display();
        message::print(&format!(
            "{path} is finished: its result is read from its journal"
        ));
        answer
    } else {
        session.work(
            &run,
            &arguments.workers.session()?,
            async |dispatch, stop| {
                let mut display = StageDisplay::new();
                let found =
                    diagnose(dispatch, &run.manifest, &target.loaded, &mut display, stop).await;
                display.clear();
                found
            },
        )?;
        DiagnosisOutput::read(&run, session.wall_s(&run))?
    };
    let object = answer.write()?;
    let file = target.folder.join("case.toml");
    if arguments.add && has_own {
        message::print(&format!(
            "{} has what this run found already",
            file.display()
        ));
    } else if arguments.add {
        answer.add(&file)?;
    }
    answer.print(arguments.output.output, &object)
}
