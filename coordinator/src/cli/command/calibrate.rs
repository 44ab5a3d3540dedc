//! `horsehead calibrate`: fits the unknowns of a case to its records and reports the result.
use crate::cli::{
    argument::{
        case::{CaseChoice, LoadedCase},
        individuals::Individuals,
        output::OutputChoice,
        settings::SettingsChoice,
        workers::WorkersChoice,
    },
    output::{
        calibration::show,
        problem::EXIT_CODES,
        progress::{Display, Silent},
    },
};
use anyhow::Context as _;
use case::require_record;
use clap::{Args, builder::PossibleValuesParser};
use protocol::case::Case;
use run::{
    calibration::{CalibrationRun, calibrate, identifiability},
    manifest::{self, DEFAULT_PRESET, FirstTable, Manifest, StartPoint},
    message,
    name::RunName,
    opened::Run,
    session::Session,
};
use search::{
    space::Space,
    strategy::{CATALOGUE, SearchPlan, Settings, build_after, preset},
};
use std::path::{Path, PathBuf};
use study::{Entry, Evaluator as _, Watch as _};
use support::Problem;

/// Fit the unknowns of a case to its records; the same command resumes.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead calibrate cases/cyjs10-5-37hb
  horsehead calibrate cases/cyjs10-5-37hb --preset paper --set encoding=gray --set population=40
  horsehead calibrate cases/cyjs10-5-37hb --listen quic/0.0.0.0:7447 --tls keys
  horsehead calibrate cases/cyjs10-5-37hb --ssh node1,node2
  horsehead calibrate cases/cyjs10-5-37hb --genes runs/cyjs10-5-37hb-diagnose-seed1/calibrated.toml
  horsehead calibrate cases/cyjs10-5-37hb --preset l-shade --start individuals.csv

Ctrl-C stops cleanly: results so far are kept, and the same command goes on.

{EXIT_CODES}"))]
pub(super) struct Arguments {
    #[command(flatten)]
    choice: CaseChoice,
    /// How to search: one of those that `horsehead presets` lists.
    #[arg(
        long,
        default_value = DEFAULT_PRESET,
        env = "HORSEHEAD_PRESET",
        hide_possible_values = true,
        value_parser = PossibleValuesParser::new(CATALOGUE.iter().map(|preset| preset.name))
    )]
    preset: String,
    /// Gene file with the values to search around instead of the recommended ones, such as the
    /// `calibrated.toml` of an earlier calibration or diagnosis.
    #[arg(long, value_name = "FILE", env = "HORSEHEAD_GENES")]
    genes: Option<PathBuf>,
    /// CSV table of individuals to evaluate first and to start the search from, with a column for each
    /// unknown that the case searches. The run keeps a copy and resumes without the file.
    #[arg(long, value_name = "FILE", env = "HORSEHEAD_START")]
    start: Option<PathBuf>,
    /// Fixes every random choice: the same seed gives the same bits.
    #[arg(long, default_value_t = 1, env = "HORSEHEAD_SEED")]
    seed: u64,
    /// Run folder [default: runs/CASE-PRESET-seedN, with what --set changes, --genes, the effects of the case and
    /// --measured].
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_RUN")]
    run: Option<PathBuf>,
    #[command(flatten)]
    settings: SettingsChoice,
    /// For the preset `window`, short for --set window=L: an individual is bred from results this many
    /// evaluations back, which affects the result [default: that of the run, or 3 times the planned workers:
    /// those started here, at least 40 with --listen or --ssh].
    #[arg(long, value_name = "L", env = "HORSEHEAD_WINDOW", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    window: Option<u32>,
    #[command(flatten)]
    output: OutputChoice,
    #[command(flatten)]
    workers: WorkersChoice,
}

/// Number of workers assumed for planning when workers of other machines may connect.
const PLANNED_REMOTE_WORKERS: usize = 40;

/// Returns the number of workers for which the run's default settings are chosen.
fn planned_workers(workers: &WorkersChoice) -> usize {
    if workers.remote.has_others() {
        workers.local().max(PLANNED_REMOTE_WORKERS)
    } else {
        workers.local()
    }
}

/// Builds the search space of the case, centred on the recommended values or on those of a gene file.
///
/// # Errors
/// If a starting value lies outside its bounds.
fn searched(case: &Case, start: Option<&StartPoint>) -> Result<Space, Problem> {
    manifest::space(case, start).map_err(|error| Problem {
        message: match start {
            Some(start) => format!("{}: {error}", start.file.display()),
            None => error.to_string(),
        },
        remedy: "choose values inside the bounds, or widen them in case.toml".to_owned(),
    })
}

/// Reads the table of individuals to start from, if one was given.
fn first_table(file: Option<&Path>, space: &Space) -> anyhow::Result<Option<FirstTable>> {
    let read = |file: &Path| -> anyhow::Result<FirstTable> {
        let rows = Individuals::read(file, space)?.rows;
        Ok(FirstTable {
            file: std::path::absolute(file)?,
            individuals: rows.iter().map(|row| space.expand(row)).collect(),
        })
    };
    file.map(read).transpose()
}

/// Checks that the chosen search can start from the table of individuals given by `--start`.
fn check_table(
    table: Option<&FirstTable>,
    settings: &Settings,
    space: &Space,
    seed: u64,
) -> Result<(), Problem> {
    let Some(table) = table else {
        return Ok(());
    };
    let built = build_after(settings, space, seed, &table.individuals);
    built.map(drop).map_err(|error| Problem {
        message: format!("{}: {error}", table.file.display()),
        remedy: "leave rows out, let the search go on for longer with --set, or score the whole table with \
               `horsehead sweep FILE`"
            .to_owned(),
    })
}

/// Creates the run of the requested calibration, or opens it to resume.
fn begin(arguments: &Arguments) -> anyhow::Result<CalibrationRun> {
    let (loaded, start) = arguments.choice.load_at(arguments.genes.as_deref())?;
    let LoadedCase {
        case,
        measured,
        synthetic,
        notes,
        ..
    } = loaded;
    let space = searched(&case, start.as_ref())?;
    let preset = preset(&arguments.preset).context("the catalogue has lost a preset")?;
    require_record(&arguments.choice.case, &case, case.objective.condition)?;
    let plan = SearchPlan {
        space: &space,
        workers: planned_workers(&arguments.workers),
    };
    let mut choice = arguments.settings.clone();
    let window = arguments.window.map(|length| length.to_string());
    choice
        .set
        .extend(window.map(|length| ("window".to_owned(), length)));
    let mut chosen = run::settings::choose(&choice.set, preset, &plan)?;
    let mut table = first_table(arguments.start.as_deref(), &space)?;
    let path = if let Some(path) = &arguments.run {
        path.clone()
    } else {
        let mut decides = chosen.set.clone();
        decides.extend(table.as_ref().map(FirstTable::word).transpose()?);
        decides.extend(start.as_ref().map(StartPoint::word).transpose()?);
        let name = RunName {
            case_folder: &arguments.choice.case,
            case: &case,
            what: preset.name,
            set: &decides,
            measured: arguments.choice.measured.as_deref(),
            seed: arguments.seed,
        };
        name.path()?
    };
    let earlier = CalibrationRun::open(&path).ok().map(|run| run.manifest);
    let earlier_settings = earlier.as_ref().map(|earlier| &earlier.settings);
    run::settings::keep_worker_dependent(&choice.set, &mut chosen, preset, earlier_settings);
    // its file is not needed again
    table = table.or_else(|| earlier.and_then(|earlier| earlier.table));
    check_table(table.as_ref(), &chosen.settings, &space, arguments.seed)?;
    let manifest = Manifest {
        preset: preset.name.to_owned(),
        set: chosen.set,
        start,
        table,
        measured,
        synthetic,
        notes,
        ..Manifest::new(&arguments.choice.case, arguments.seed, chosen.settings)?
    };
    Run::begin(&path, manifest, case)
}

/// Runs the calibration from the first proposal to the report.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let session = Session::begin();
    let run = begin(arguments)?;
    if run.lost_journal() {
        message::print(&format!(
            "warning: the journal of {} is missing or empty, so earlier results are lost: the run starts \
             again",
            run.folder.path().display()
        ));
    }
    session.work(
        &run,
        &arguments.workers.session()?,
        async |dispatch, stop| {
            let mut display =
                Display::new(run.case.objective_unit()).of_preset(&run.manifest.preset);
            display.resumed(dispatch.recorded());
            let found = calibrate(dispatch, &run, &mut display, stop).await;
            display.clear();
            let best = found?.calibrated.best.genes;
            let seen = identifiability(dispatch, &run, &best, &mut Silent, stop).await?;
            let estimates = seen.as_ref().map(|seen| seen.unknowns.clone());
            dispatch.enter(&Entry::Estimated(estimates.unwrap_or_default()))?;
            let file = seen.and_then(|seen| {
                let unknowns: Vec<&str> =
                    seen.unknowns.iter().map(|own| own.name.as_str()).collect();
                let kind = case::kind::of(&run.case);
                kind.jacobian_file(&run.case, &unknowns, &seen.channels, &seen.derivatives)
            });
            if let Some((name, bytes)) = file {
                run.folder.write(name, &bytes)?;
            }
            Ok(())
        },
    )?;
    show(&run, session.wall_s(&run), arguments.output.output)
}
