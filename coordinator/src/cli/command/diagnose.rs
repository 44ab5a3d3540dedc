//! `horsehead diagnose`: where simulation and measured records differ, which missing effect explains the
//! difference, how certain that is, and how far the gap closes.
use crate::cli::{
    argument::{output::OutputChoice, study::StudyArguments, workers::WorkersChoice},
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
};

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
    #[command(flatten)]
    study: StudyArguments,
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
    /// Append what is found to the case's case.toml.
    #[arg(long, env = "HORSEHEAD_ADD")]
    add: bool,
    #[command(flatten)]
    output: OutputChoice,
    #[command(flatten)]
    workers: WorkersChoice,
}

/// Runs the diagnosis from the measured records to the report.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let session = Session::begin();
    let mut target = arguments.study.read()?;
    let seed = target.seed(arguments.study.seed);
    let settings = DiagnosisSettings {
        thresholds: Thresholds {
            rounds: usize::from(arguments.rounds),
            simulations: target.loaded.diagnose.simulations,
            without: arguments.without.clone(),
            ..Thresholds::default()
        },
        differences: arguments.study.differences,
    };
    let path = match &arguments.study.run {
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
