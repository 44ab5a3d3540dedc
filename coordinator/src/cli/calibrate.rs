//! `horsehead calibrate`: identify the parameters, and show what it brought.
use super::{
    CaseChoice, EXIT_CODES, LoadedCase, OutputChoice, bus, cores, interrupt, output,
    problem::Usage,
    progress::Display,
    run_folder::{Begun, Manifest, RunFolder, command_line},
};
use crate::{
    cli::finish::{self, Session},
    study::StudyError,
};
use clap::Args;
use link::locator::Locator;
use search::{
    space::Space,
    strategy::{CATALOGUE, Preset, preset},
};
use std::{path::PathBuf, time::Instant};

/// Identify stiffness and damping from the gauge records; the same command resumes.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead calibrate cases/cyjs10-5-37hb
  horsehead calibrate cases/cyjs10-5-37hb --preset paper --seed 7 --listen tcp/127.0.0.1:7447

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
    /// Fixes every random choice: the same seed gives the same bits.
    #[arg(long, default_value_t = 1, env = "HORSEHEAD_SEED")]
    seed: u64,
    /// Run folder [default: runs/CASE-PRESET-seedN].
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_RUN")]
    run: Option<PathBuf>,
    /// Where workers on other machines may connect, as `quic/0.0.0.0:7447`.
    #[arg(long, value_name = "LOCATOR", env = "HORSEHEAD_LISTEN")]
    listen: Option<String>,
    /// Allow other machines to connect without certificates.
    #[arg(long, env = "HORSEHEAD_INSECURE")]
    insecure: bool,
    /// Worker processes to start on this machine; 0 for none [default: one per core].
    #[arg(long, value_name = "N", env = "HORSEHEAD_WORKERS", value_parser = clap::value_parser!(u16).range(0..=1024))]
    workers: Option<u16>,
    #[command(flatten)]
    output: OutputChoice,
}

fn presets() -> String {
    let line = |preset: &Preset| format!("  {:<12} {}\n", preset.name, preset.summary);
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

fn known_preset(name: &str) -> Result<&'static Preset, Usage> {
    preset(name).ok_or_else(|| {
        let known: Vec<&str> = CATALOGUE.iter().map(|preset| preset.name).collect();
        Usage {
            message: format!("there is no preset `{name}`"),
            help: format!("choose one of: {}", known.join(", ")),
        }
    })
}

/// Refuses addresses that cannot work before anything is written.
fn check_bus(listen: Option<&str>, insecure: bool, local_workers: usize) -> Result<(), Usage> {
    let Some(listen) = listen else {
        if local_workers == 0 {
            return Err(Usage {
                message: "nobody would compute: no local workers, and nowhere to listen".to_owned(),
                help: "give --listen LOCATOR for workers elsewhere, or --workers 1".to_owned(),
            });
        }
        return Ok(());
    };
    Locator::parse(listen)
        .and_then(|locator| locator.permit(insecure))
        .map_err(|error| Usage {
            message: format!("--listen {listen}: {error}"),
            help: "on this machine use tcp/127.0.0.1:7447; for other machines quic/0.0.0.0:7447 \
                   with certificates, or tcp/0.0.0.0:7447 with --insecure"
                .to_owned(),
        })
}

/// Calibrates from the first proposal to the report.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let LoadedCase {
        case,
        measured,
        notes,
    } = arguments.choice.load()?;
    let space = Space::new(&case.genes)?;
    let preset = known_preset(&arguments.preset)?;
    let objective = case.conditions.get(case.objective.condition);
    if objective.is_none_or(|condition| condition.record.is_none()) {
        return Err(Usage {
            message: "the condition of the objective has no gauge record".to_owned(),
            help: "add `record` to that condition in case.toml, or give --measured DIR".to_owned(),
        }
        .into());
    }
    let manifest = Manifest {
        format: Manifest::format(),
        program: bus::PROGRAM.to_owned(),
        command: command_line(),
        preset: preset.name.to_owned(),
        seed: arguments.seed,
        settings: (preset.settings)(&space),
        case_folder: std::path::absolute(&arguments.choice.case)?,
        measured,
        notes,
        wall_s: 0.0,
    };
    let local_workers = arguments.workers.map_or_else(cores, usize::from);
    check_bus(
        arguments.listen.as_deref(),
        arguments.insecure,
        local_workers,
    )?;
    let path = arguments
        .run
        .clone()
        .unwrap_or_else(|| RunFolder::default_path(&case.name, preset.name, arguments.seed));
    let Begun {
        folder,
        resumed,
        wall_s,
    } = RunFolder::begin(&path, &manifest, &case)?;
    let verb = if resumed {
        "going on with"
    } else {
        "beginning"
    };
    output::tell(&format!("{verb} {}", path.display()));

    let session = Session {
        folder: &folder,
        manifest: &manifest,
        case: &case,
        earlier_s: wall_s,
        started: Instant::now(),
        listen: arguments.listen.clone(),
        insecure: arguments.insecure,
        local_workers,
        replay: false,
    };
    let result = bus::block_on(async {
        let mut stop = interrupt::listen();
        let mut display = Display::new();
        let result = session.run(&mut display, &mut stop).await;
        display.clear();
        result
    });
    folder.spent(&manifest, session.wall_s())?;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_that_cannot_work_are_refused_with_a_remedy() {
        for (listen, insecure, workers, words) in [
            (None, false, 0, "nobody would compute"),
            (Some("nonsense"), false, 2, "nonsense"),
            (Some("udp/127.0.0.1:7447"), false, 2, "udp"),
            (
                Some("tcp/0.0.0.0:7447"),
                false,
                2,
                "--listen tcp/0.0.0.0:7447",
            ),
        ] {
            let refused = check_bus(listen, insecure, workers).unwrap_err();
            assert!(refused.message.contains(words), "{}", refused.message);
            assert!(!refused.help.is_empty());
        }
        for (listen, insecure, workers) in [
            (None, false, 1),
            (Some("tcp/127.0.0.1:7447"), false, 0),
            (Some("tcp/0.0.0.0:7447"), true, 0),
            (Some("quic/0.0.0.0:7447"), false, 0),
        ] {
            assert!(check_bus(listen, insecure, workers).is_ok(), "{listen:?}");
        }
    }

    #[test]
    fn an_unknown_preset_names_those_there_are() {
        let refused = known_preset("deep").err().map(|usage| usage.help);
        assert!(refused.is_some_and(|help| help.contains("quick, paper")));
    }
}
