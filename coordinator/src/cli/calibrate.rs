//! `horsehead calibrate`: identify the parameters, and show what it brought.
use super::{
    CaseChoice, Door, EXIT_CODES, LoadedCase, OutputChoice, bus, cores, interrupt, output,
    problem::Usage,
    progress::Display,
    run_folder::{self, Begun, CALIBRATE, Manifest, RunFolder, Start, command_line},
};
use crate::{
    cli::finish::{self, Session},
    study::StudyError,
};
use clap::Args;
use protocol::case::Case;
use search::{
    space::Space,
    strategy::{CATALOGUE, Preset, Settings, memetic::window::WindowSettings, preset},
};
use std::{
    path::{Path, PathBuf},
    time::Instant,
};

/// Identify stiffness and damping from the gauge records; the same command resumes.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead calibrate cases/cyjs10-5-37hb
  horsehead calibrate cases/cyjs10-5-37hb --preset paper --seed 7 --listen tcp/127.0.0.1:7447
  horsehead calibrate cases/cyjs10-5-37hb --listen quic/0.0.0.0:7447 --tls keys
  horsehead calibrate cases/cyjs10-5-37hb --genes runs/cyjs10-5-37hb-diagnose-seed1/calibrated.toml

Presets:
{}
Ctrl-C stops cleanly: results so far are kept, and the same command goes on.
{EXIT_CODES}", presets()))]
pub(super) struct Arguments {
    #[command(flatten)]
    choice: CaseChoice,
    /// How to search; see below.
    #[arg(long, default_value = "quick", env = "HORSEHEAD_PRESET")]
    preset: String,
    /// Gene file to search around instead of the recommended values, such as the `calibrated.toml` of
    /// an earlier calibration or diagnosis.
    #[arg(long, value_name = "FILE", env = "HORSEHEAD_GENES")]
    genes: Option<PathBuf>,
    /// Fixes every random choice: the same seed gives the same bits.
    #[arg(long, default_value_t = 1, env = "HORSEHEAD_SEED")]
    seed: u64,
    /// Run folder [default: runs/CASE-PRESET-seedN, with --measured also the folder's name and the
    /// start of its records' hash].
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_RUN")]
    run: Option<PathBuf>,
    /// Of the preset `window`: an individual is bred from results that are this many behind, part
    /// of what decides the result [default: that of the run, or 3 times the workers planned:
    /// those started here, 40 at least with --listen].
    #[arg(long, value_name = "L", env = "HORSEHEAD_WINDOW", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    window: Option<u32>,
    #[command(flatten)]
    door: Door,
    /// Worker processes to start on this machine; 0 for none [default: one per core].
    #[arg(long, value_name = "N", env = "HORSEHEAD_WORKERS", value_parser = super::worker_count())]
    workers: Option<usize>,
    #[command(flatten)]
    output: OutputChoice,
}

fn presets() -> String {
    let line = |preset: &Preset| format!("  {:<14} {}\n", preset.name, preset.summary);
    CATALOGUE.iter().map(line).collect()
}

/// Whether the same command may bring more: not if the case or the workers are at fault.
fn can_go_on(error: &anyhow::Error) -> bool {
    let study = error.downcast_ref::<StudyError>();
    matches!(
        study,
        Some(StudyError::Interrupted | StudyError::Evaluator(_))
    )
}

/// The preset of a name.
fn chosen_preset(name: &str) -> Result<&'static Preset, Usage> {
    preset(name).ok_or_else(|| {
        let known: Vec<&str> = CATALOGUE.iter().map(|preset| preset.name).collect();
        Usage {
            message: format!("there is no preset `{name}`"),
            help: format!("choose one of: {}", known.join(", ")),
        }
    })
}

/// Workers to plan for where any number of machines may connect.
const LISTENING: usize = 40;

/// Puts the window that was asked for, or that fits the workers planned, into settings that have
/// one; a run that was begun keeps its own.
fn set_window(
    settings: &mut Settings,
    arguments: &Arguments,
    path: &Path,
    local_workers: usize,
) -> Result<(), Usage> {
    let Settings::Window(window) = settings else {
        return match arguments.window {
            None => Ok(()),
            Some(_) => Err(Usage {
                message: format!("the preset `{}` has no --window", arguments.preset),
                help: "say --preset window, or leave --window out".to_owned(),
            }),
        };
    };
    let earlier = RunFolder::open::<Settings>(path, CALIBRATE)
        .ok()
        .and_then(|(_, earlier, _)| match earlier.settings {
            Settings::Window(earlier) => Some(earlier.window),
            Settings::Memetic(_) | Settings::Quick(_) => None,
        });
    let planned = match arguments.door.listen {
        Some(_) => local_workers.max(LISTENING),
        None => local_workers,
    };
    window.window = match arguments.window {
        Some(asked) => asked as usize,
        None => earlier.unwrap_or_else(|| WindowSettings::window_for(planned)),
    };
    Ok(())
}

/// The space to search, about the recommended values or those of a start.
fn searched(case: &Case, start: Option<&Start>) -> Result<Space, Usage> {
    run_folder::space(case, start).map_err(|error| Usage {
        message: match start {
            Some(start) => format!("{}: {error}", start.file.display()),
            None => error.to_string(),
        },
        help: "choose values inside the bounds, or widen them in case.toml".to_owned(),
    })
}

fn warn_of_lost_journal(folder: &Path) {
    output::tell(&format!(
        "warning: the journal of {} is gone or empty, and with it the results: the run begins \
         anew",
        folder.display()
    ));
}

/// Calibrates from the first proposal to the report.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let LoadedCase {
        case,
        measured,
        synthetic,
        notes,
    } = arguments.choice.load()?;
    let start = Start::read(arguments.genes.as_deref(), &case)?;
    let space = searched(&case, start.as_ref())?;
    let preset = chosen_preset(&arguments.preset)?;
    let objective = case.conditions.get(case.objective.condition);
    if objective.is_none_or(|condition| condition.record.is_none()) {
        return Err(Usage {
            message: "the condition of the objective has no gauge record".to_owned(),
            help: "add `record` to that condition in case.toml, or give --measured DIR".to_owned(),
        }
        .into());
    }
    let local_workers = arguments.workers.unwrap_or_else(cores);
    let path = if let Some(path) = &arguments.run {
        path.clone()
    } else {
        let replaced = arguments.choice.measured.as_deref();
        RunFolder::default_path(&case, preset.name, replaced, arguments.seed)?
    };
    let mut settings = (preset.settings)(&space);
    set_window(&mut settings, arguments, &path, local_workers)?;
    let manifest = Manifest {
        kind: CALIBRATE.to_owned(),
        format: run_folder::format(),
        program: bus::PROGRAM.to_owned(),
        command: command_line(),
        preset: preset.name.to_owned(),
        seed: arguments.seed,
        settings,
        start,
        case_folder: std::path::absolute(&arguments.choice.case)?,
        measured,
        synthetic,
        notes,
        wall_s: 0.0,
    };
    let Begun {
        folder,
        lost_journal,
        resumed,
        wall_s,
    } = RunFolder::begin(&path, &manifest, &case)?;
    if lost_journal {
        warn_of_lost_journal(&path);
    }

    let session = Session {
        folder: &folder,
        manifest: &manifest,
        case: &case,
        earlier_s: wall_s,
        started: Instant::now(),
        door: arguments.door.clone(),
        local_workers,
        resumed,
    };
    let result = bus::block_on(async {
        let mut stop = interrupt::listen();
        let mut display = Display::new();
        let result = session.run(&mut display, &mut stop).await;
        display.clear();
        result
    });
    let result = result.inspect_err(|error| {
        if !can_go_on(error) {
            return;
        }
        output::tell(&format!(
            "results so far are kept in {}; to go on:\n  {}",
            path.display(),
            manifest.command
        ));
    })?;
    finish::show(&session, &result, arguments.output.output)
}
