//! `horsehead diagnose`: where simulation and record part, which missing effect explains it, how sure
//! that is, and how far the gap closes.
use crate::{
    case::{Loaded, Overrides, load_with_notes, require_record},
    cli::{
        argument::{
            door::Door,
            output::OutputChoice,
            workers::{cores, worker_count},
        },
        output::{
            diagnosis::Answer,
            problem::{EXIT_CODES, Usage},
            progress::StageDisplay,
            terminal,
        },
        run::{
            begun::Run,
            bus,
            calibration::Calibration,
            command_line::command_line,
            diagnosis::{Decides, Diagnosis, diagnose},
            folder::{GENES, RunFolder},
            manifest::{self, CALIBRATE, DIAGNOSE, Manifest, Start},
            session::Session,
        },
    },
};
use clap::Args;
use discrepancy::thresholds::Thresholds;
use std::{path::PathBuf, time::Instant};

/// Find what the simulation is missing: where, which effect, how large, and the proof.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead diagnose cases/cyjs10-5-37hb
  horsehead diagnose runs/cyjs10-5-37hb-quick-seed1
  horsehead diagnose cases/cyjs10-5-37hb --measured tests/of/march --output json

A case is recalibrated from scratch; a finished run of `calibrate` gives its parameters as the start.
What is found is written into effects.toml of the run folder, in the form that case.toml takes; --add
appends it to the case itself, and from then on it is ordinary physics.
Ctrl-C stops cleanly: results so far are kept, and the same command goes on.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Case folder, or the folder of a finished calibration.
    #[arg(value_name = "CASE|RUN")]
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
    /// Take every derivative as a difference of whole simulations, as if the model gave none: slower, and
    /// the judge of the exact ones.
    #[arg(long, env = "HORSEHEAD_DIFFERENCES")]
    differences: bool,
    /// Append what is found to the case's case.toml.
    #[arg(long, env = "HORSEHEAD_ADD")]
    add: bool,
    /// Fixes every random choice: the same seed gives the same bits.
    #[arg(long, default_value_t = 1, env = "HORSEHEAD_SEED")]
    seed: u64,
    /// Run folder [default: runs/CASE-diagnose-seedN, with --measured also the folder's name and the
    /// start of its records' hash].
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_RUN")]
    run: Option<PathBuf>,
    #[command(flatten)]
    door: Door,
    /// Worker processes to start on this machine; 0 for none [default: one per core].
    #[arg(long, value_name = "N", env = "HORSEHEAD_WORKERS", value_parser = worker_count())]
    workers: Option<usize>,
    #[command(flatten)]
    output: OutputChoice,
}

/// What is diagnosed, and where it came from.
struct Target {
    /// Folder of the case.
    folder: PathBuf,
    /// Folder of the records, where they replace the case's.
    measured: Option<PathBuf>,
    loaded: Loaded,
    /// Where the recalibration starts, if that is known.
    start: Option<Start>,
}

impl Target {
    /// Without what this very diagnosis has added to the case; the start is one of what is left.
    fn without_found_by(mut self, earlier: &Diagnosis) -> anyhow::Result<Self> {
        let stated = self.loaded.case.unknowns.clone();
        self.loaded = earlier.as_begun(self.loaded)?;
        let left = &self.loaded.case.unknowns;
        let kept = |values: Vec<f64>| {
            let pairs = stated.iter().zip(values);
            let kept = pairs.filter(|(gene, _)| left.contains(gene));
            kept.map(|(_, value)| value).collect()
        };
        self.start = self.start.map(|start| Start {
            genes: kept(start.genes),
            ..start
        });
        Ok(self)
    }
}

/// Diagnoses from the record to the report.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let session = Session {
        door: arguments.door.clone(),
        local_workers: arguments.workers.unwrap_or_else(cores),
        started: Instant::now(),
    };
    let mut target = target(arguments)?;
    let path = if let Some(path) = &arguments.run {
        path.clone()
    } else {
        let measured = target.measured.as_deref();
        RunFolder::default_path(&target.loaded.case, DIAGNOSE, &[], measured, arguments.seed)?
    };
    let stated = target.loaded.effects.len();
    if let Ok(earlier) = Diagnosis::open(&path) {
        target = target.without_found_by(&earlier)?;
    }
    let has_own = target.loaded.effects.len() < stated;
    for note in &target.loaded.notes {
        terminal::tell(&format!("note: {note}"));
    }
    let manifest = manifest(arguments, &target)?;
    let run = Run::begin(&path, manifest, target.loaded.case.clone())?;
    let found = session.work(&run, async |bus, stop| {
        let mut display = StageDisplay::new();
        let found = diagnose(bus, &run.manifest, &target.loaded, &mut display, stop).await;
        display.clear();
        found
    })?;
    let answer = Answer {
        run: &run,
        loaded: &target.loaded,
        found: &found,
        wall_s: session.wall_s(&run),
    };
    let object = answer.write()?;
    let file = target.folder.join("case.toml");
    if arguments.add && has_own {
        terminal::tell(&format!(
            "{} has what this run found already",
            file.display()
        ));
    } else if arguments.add {
        answer.add(&file)?;
    }
    answer.print(arguments.output.output, &object)
}

/// What decides the diagnosis, and how it was asked for.
fn manifest(arguments: &Arguments, target: &Target) -> anyhow::Result<Manifest<Decides>> {
    Ok(Manifest {
        kind: DIAGNOSE.to_owned(),
        format: manifest::FORMAT,
        program: bus::PROGRAM.to_owned(),
        command: command_line(),
        preset: String::new(),
        set: Vec::new(),
        seed: arguments.seed,
        settings: Decides {
            thresholds: Thresholds {
                rounds: usize::from(arguments.rounds),
                without: arguments.without.clone(),
                ..Thresholds::default()
            },
            differences: arguments.differences,
        },
        start: target.start.clone(),
        case_folder: std::path::absolute(&target.folder)?,
        measured: target
            .measured
            .as_ref()
            .unwrap_or(&target.folder)
            .display()
            .to_string(),
        synthetic: target.loaded.synthetic,
        notes: target
            .loaded
            .notes
            .iter()
            .map(ToString::to_string)
            .collect(),
        wall_s: 0.0,
    })
}

/// The case, and where the recalibration starts.
fn target(arguments: &Arguments) -> anyhow::Result<Target> {
    let folder = RunFolder::new(&arguments.target);
    let (case, records, genes) = if folder.is_begun() {
        let calibration = finished(&folder)?;
        let manifest = calibration.manifest;
        let records = manifest.replaced_records().map(ToOwned::to_owned);
        (manifest.case_folder, records, Some(folder.file(GENES)))
    } else {
        (arguments.target.clone(), None, None)
    };
    let measured = arguments.measured.clone().or(records);
    let overrides = Overrides {
        measured: measured.clone(),
    };
    let loaded = load_with_notes(&case, &overrides)?;
    require_record(&case, &loaded.case, loaded.case.objective.condition)?;
    let genes = arguments.genes.clone().or(genes);
    let start = Start::read(genes.as_deref(), &loaded.case)?;
    Ok(Target {
        folder: case,
        measured,
        loaded,
        start,
    })
}

/// A calibration that came to its end.
fn finished(folder: &RunFolder) -> anyhow::Result<Calibration> {
    let path = folder.path();
    let kind = folder.head()?.kind;
    if kind != CALIBRATE {
        return Err(Usage {
            message: format!("{} holds a run of `horsehead {kind}`", path.display()),
            help: "name a case folder, or the folder of a calibration".to_owned(),
        }
        .into());
    }
    let calibration = Calibration::open(path)?;
    if folder.file(GENES).exists() {
        return Ok(calibration);
    }
    Err(Usage {
        message: format!("{} is not finished", path.display()),
        help: format!("finish it first:\n  {}", calibration.resume_command()),
    }
    .into())
}
