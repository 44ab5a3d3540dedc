//! `horsehead diagnose`: where simulation and record part, which missing effect explains it, how sure
//! that is, and how far the gap closes.
use super::{
    Door, EXIT_CODES, OutputChoice,
    answer::Answer,
    bus, cores,
    diagnosed::Earlier,
    interrupt, output,
    problem::Usage,
    progress::StageDisplay,
    run_folder::{self, Begun, CALIBRATE, DIAGNOSE, Manifest, RunFolder, Start, command_line},
};
use crate::{
    case::{Loaded, Overrides, load_with_notes},
    study::{self, Diagnosed, Evaluator, StudyError},
};
use clap::Args;
use discrepancy::{diagnose::Inputs, settings::Settings};
use protocol::{announce::EffectDescriptor, job::Refinement};
use search::space::Space;
use serde::{Deserialize, Serialize};
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
    /// Folder whose load cards and gauge records replace those of the case: a new test of the
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
    #[arg(long, value_name = "N", env = "HORSEHEAD_WORKERS", value_parser = super::worker_count())]
    workers: Option<usize>,
    #[command(flatten)]
    output: OutputChoice,
}

/// Everything that decides a diagnosis beside case and seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Decides {
    /// Thresholds.
    thresholds: Settings,
}

impl run_folder::Decides for Decides {}

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
    fn without_found_by(mut self, earlier: &Earlier) -> anyhow::Result<Self> {
        let stated = self.loaded.case.genes.clone();
        self.loaded = earlier.as_begun(self.loaded)?;
        let left = &self.loaded.case.genes;
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
    let started = Instant::now();
    let mut target = target(arguments)?;
    let path = if let Some(path) = &arguments.run {
        path.clone()
    } else {
        let measured = target.measured.as_deref();
        RunFolder::default_path(&target.loaded.case, DIAGNOSE, measured, arguments.seed)?
    };
    let stated = target.loaded.effects.len();
    if let Ok(earlier) = Earlier::open(&path) {
        target = target.without_found_by(&earlier)?;
    }
    let has_own = target.loaded.effects.len() < stated;
    for note in &target.loaded.notes {
        output::tell(&format!("note: {note}"));
    }
    let case = &target.loaded.case;
    let manifest = manifest(arguments, &target)?;
    let begun = RunFolder::begin(&path, &manifest, case)?;
    let (diagnosed, library) =
        experiment(arguments, &manifest, &begun, &target).inspect_err(|error| {
            let study = error.downcast_ref::<StudyError>();
            if matches!(
                study,
                Some(StudyError::Interrupted | StudyError::Evaluator(_))
            ) {
                output::tell(&format!(
                    "results so far are kept in {}; to go on:\n  {}",
                    path.display(),
                    manifest.command
                ));
            }
        })?;
    let wall_s = begun.wall_s + started.elapsed().as_secs_f64();
    begun.folder.spent(&manifest, case, wall_s)?;
    let answer = Answer {
        folder: &begun.folder,
        manifest: &manifest,
        loaded: &target.loaded,
        diagnosed: &diagnosed,
        library: &library,
        wall_s,
    };
    let object = answer.write()?;
    let file = target.folder.join("case.toml");
    if arguments.add && has_own {
        output::tell(&format!(
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
        format: run_folder::format(),
        program: bus::PROGRAM.to_owned(),
        command: command_line(),
        preset: String::new(),
        seed: arguments.seed,
        settings: Decides {
            thresholds: Settings {
                rounds: usize::from(arguments.rounds),
                without: arguments.without.clone(),
                ..Settings::default()
            },
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
    let kind = RunFolder::kind(&arguments.target);
    let (folder, measured, genes) = match kind.as_deref() {
        Some(CALIBRATE) => {
            let (folder, manifest, _) =
                RunFolder::open::<search::strategy::Settings>(&arguments.target, CALIBRATE)?;
            let genes = folder.file("calibrated.toml");
            if !genes.exists() {
                return Err(Usage {
                    message: format!("{} is not finished", arguments.target.display()),
                    help: format!(
                        "finish it first:\n  {}",
                        manifest.resume_command(&arguments.target)
                    ),
                }
                .into());
            }
            let own = PathBuf::from(&manifest.measured);
            let replaced = std::path::absolute(&own)? != manifest.case_folder;
            let measured = arguments
                .measured
                .clone()
                .or_else(|| replaced.then_some(own));
            (manifest.case_folder, measured, Some(genes))
        }
        Some(other) => {
            return Err(Usage {
                message: format!(
                    "{} holds a run of `horsehead {other}`",
                    arguments.target.display()
                ),
                help: "name a case folder, or the folder of a calibration".to_owned(),
            }
            .into());
        }
        None => (arguments.target.clone(), arguments.measured.clone(), None),
    };
    let overrides = Overrides {
        measured: measured.clone(),
    };
    let loaded = load_with_notes(&folder, &overrides)?;
    let genes = arguments.genes.clone().or(genes);
    let start = Start::read(genes.as_deref(), &loaded.case)?;
    Ok(Target {
        folder,
        measured,
        loaded,
        start,
    })
}

/// Opens the bus, learns the library and diagnoses.
fn experiment(
    arguments: &Arguments,
    manifest: &Manifest<Decides>,
    begun: &Begun,
    target: &Target,
) -> anyhow::Result<(Diagnosed, Vec<EffectDescriptor>)> {
    let case = &target.loaded.case;
    bus::block_on(async {
        let mut stop = interrupt::listen();
        let options = bus::Options {
            run_dir: begun.folder.path().to_owned(),
            door: arguments.door.clone(),
            local_workers: arguments.workers.unwrap_or_else(cores),
            kind: DIAGNOSE.to_owned(),
            settings: manifest.settings_json()?,
        };
        let mut bus = bus::Bus::open(options, case).await?;
        begun.folder.spent(manifest, case, begun.wall_s)?;
        let path = begun.folder.path().display();
        output::tell(&match bus.recorded() {
            0 => format!("beginning {path}"),
            recorded => format!("going on with {path}: its journal holds {recorded} results"),
        });
        let mut display = StageDisplay::new();
        let found = diagnose(&mut bus, manifest, &target.loaded, &mut display, &mut stop).await;
        display.clear();
        let closed = bus.close().await;
        let found = found?;
        closed?;
        Ok(found)
    })
}

/// Learns the library and diagnoses, on whatever evaluates.
pub(super) async fn diagnose<E: Evaluator>(
    evaluator: &mut E,
    manifest: &Manifest<Decides>,
    loaded: &Loaded,
    display: &mut dyn study::Watch,
    stop: &mut study::Stop,
) -> anyhow::Result<(Diagnosed, Vec<EffectDescriptor>)> {
    let library = study::library(evaluator, stop).await?;
    let thresholds = &manifest.settings.thresholds;
    for id in &thresholds.without {
        if library.iter().all(|effect| effect.id != *id) {
            let names = library.iter().filter(|e| !e.generic).map(|e| e.id.as_str());
            let known: Vec<&str> = names.collect();
            return Err(Usage {
                message: format!("the workers know no effect `{id}`"),
                help: format!("they know: {}", known.join(", ")),
            }
            .into());
        }
    }
    let inputs = inputs(loaded, manifest, library)?;
    let diagnosed = study::diagnose_on(evaluator, &inputs, display, stop).await?;
    Ok((diagnosed, inputs.library))
}

/// What the pipeline takes: the calibrated condition's record first.
fn inputs(
    loaded: &Loaded,
    manifest: &Manifest<Decides>,
    library: Vec<EffectDescriptor>,
) -> anyhow::Result<Inputs> {
    let case = &loaded.case;
    let space = Space::new(&case.genes)?;
    let calibrated = case.objective.condition;
    let mut records = loaded.cycles.clone();
    records.sort_by_key(|record| record.condition != calibrated);
    records.retain(|record| record.condition == calibrated || !record.cycles.is_empty());
    // effects that the case has already are ordinary physics, not suspects
    let library = library
        .into_iter()
        .filter(|effect| case.effects.iter().all(|own| own.id != effect.id))
        .collect();
    let available = case.modal_head.frequencies_hz.len();
    Ok(Inputs {
        start: manifest.start_genes().map(|genes| space.point(genes)),
        space,
        records,
        library,
        usual: Refinement {
            longest_step_s: Some(manifest.settings.thresholds.step * case.run.longest_step_s),
            ..Refinement::default()
        },
        finer: Refinement {
            cylinder_length_m: Some(
                case.ropes.cylinder_length_m * manifest.settings.thresholds.refinement,
            ),
            lead_in_deg: Some(case.run.lead_in_deg + 180.0),
            modes: Some((case.run.modes + 2).min(available)),
            longest_step_s: Some(0.5 * manifest.settings.thresholds.step * case.run.longest_step_s),
            tolerance: None,
        },
        seed: manifest.seed,
        settings: manifest.settings.thresholds.clone(),
    })
}
