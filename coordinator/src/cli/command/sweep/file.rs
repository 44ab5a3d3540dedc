//! `horsehead sweep FILE`: runs every search of a grid of settings, or scores every individual of a table.
use super::grid::{Grid, rows};
use crate::cli::{
    argument::{
        case::{LoadedCase, case_folder, load_case},
        individuals::Individuals,
        output::OutputChoice,
        workers::WorkersChoice,
    },
    output::{progress::Display, sweep::show_file},
};
use case::{document::Document, require_record};
use clap::Args;
use run::{
    hash,
    manifest::Manifest,
    name::RunName,
    opened::Run,
    searches::Searches,
    session::Session,
    sweep_file::{FileContent, SweptFile},
};
use search::space::Space;
use std::path::{Path, PathBuf};
use study::{Entry, Evaluator as _, Sweep, Watch as _, score_all};
use support::Problem;

#[derive(Debug, Args)]
pub(super) struct FileArguments {
    /// A grid of settings (.toml) or a table of individuals (.csv).
    #[arg(value_name = "FILE", required = true)]
    file: Option<PathBuf>,
    /// Case folder; a grid may name its own.
    #[arg(long, value_name = "CASE", env = "HORSEHEAD_CASE", value_parser = case_folder)]
    case: Option<PathBuf>,
    /// Folder whose inputs and records replace those of the case.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_MEASURED")]
    measured: Option<PathBuf>,
    /// Run folder [default: runs/CASE-sweep-FILE-seed0].
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_RUN")]
    run: Option<PathBuf>,
    #[command(flatten)]
    output: OutputChoice,
    #[command(flatten)]
    workers: WorkersChoice,
}

/// Runs the sweep that a grid file or a table of individuals defines.
pub(super) fn run(arguments: &FileArguments) -> anyhow::Result<()> {
    let session = Session::begin();
    let (run, all) = begin(arguments)?;
    match (&run.manifest.settings.holds, all) {
        (FileContent::Grid(searches), _) => search((&session, arguments), &run, searches)?,
        (FileContent::Individuals(_), all) => score((&session, arguments), &run, &all)?,
    }
    show_file(&run, arguments.output.output)
}

/// Creates or opens the run of a sweep, and reads the individuals if the file is a table; for a grid the list
/// is empty.
fn begin(arguments: &FileArguments) -> anyhow::Result<(Run<SweptFile>, Individuals)> {
    let file = arguments.file.clone().unwrap_or_default();
    let ends = file.extension().and_then(|end| end.to_str());
    let grid = match ends {
        Some("toml") => {
            let document = Document::read(&file, "the grid that was asked for")?;
            Some((document.parse::<Grid>()?, document))
        }
        Some("csv") => None,
        Some(_) | None => {
            return Err(Problem {
                message: format!("{} is neither a grid nor a table", file.display()),
                remedy: "a grid ends in .toml, a table of individuals in .csv".to_owned(),
            }
            .into());
        }
    };
    let beside = |case: &PathBuf| file.parent().unwrap_or(Path::new("")).join(case);
    let own = grid
        .as_ref()
        .and_then(|(grid, _)| grid.case.as_ref().map(beside));
    let Some(case_folder) = arguments.case.clone().or(own) else {
        return Err(Problem {
            message: format!("{}: no case folder is given", file.display()),
            remedy: "name its folder with --case CASE, in a grid with `case = \"FOLDER\"`"
                .to_owned(),
        }
        .into());
    };
    let measured = arguments.measured.as_deref();
    let LoadedCase {
        case,
        measured: records,
        synthetic,
        notes,
        ..
    } = load_case(&case_folder, measured)?;
    require_record(&case_folder, &case, case.objective.condition)?;
    let space = Space::new(&case.unknowns)?;
    let (holds, all) = if let Some((grid, document)) = grid {
        let searches = grid.searches(&document, &space)?;
        (FileContent::Grid(searches), Individuals::default())
    } else {
        let all = Individuals::read(&file, &space)?;
        let hash = hash::content_hash(&all.rows)?.to_string();
        (FileContent::Individuals(hash), all)
    };
    let path = if let Some(path) = &arguments.run {
        path.clone()
    } else {
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        let name = RunName {
            case_folder: &case_folder,
            case: &case,
            what: "sweep",
            set: &[stem.into_owned()],
            measured,
            seed: 0,
        };
        name.path()?
    };
    let settings = SweptFile {
        file: std::path::absolute(&file)?,
        holds,
    };
    let manifest = Manifest {
        measured: records,
        synthetic,
        notes,
        ..Manifest::new(&case_folder, 0, settings)?
    };
    Ok((Run::begin(&path, manifest, case)?, all))
}

/// Runs every search of a grid of settings.
fn search(
    (session, arguments): (&Session, &FileArguments),
    run: &Run<SweptFile>,
    searches: &Searches,
) -> anyhow::Result<()> {
    let space = Space::new(&run.case.unknowns)?;
    let rows = rows(searches);
    let list = searches.list(&space, &rows)?;
    session.work(
        run,
        &arguments.workers.session()?,
        async |dispatch, stop| {
            let mut display = Display::counting("searches done", run.case.objective_unit());
            display.resumed(dispatch.recorded());
            let mut sweep = Sweep::new(&run.case, &space);
            let found = sweep.run(dispatch, &list, &mut display, stop).await;
            display.clear();
            Ok(dispatch.enter(&Entry::Swept(searches.tried(&rows, &found?)))?)
        },
    )
}

/// Scores every individual of a table.
fn score(
    (session, arguments): (&Session, &FileArguments),
    run: &Run<SweptFile>,
    all: &Individuals,
) -> anyhow::Result<()> {
    let space = Space::new(&run.case.unknowns)?;
    let individuals: Vec<Vec<f64>> = all.rows.iter().map(|row| space.expand(row)).collect();
    session.work(
        run,
        &arguments.workers.session()?,
        async |dispatch, stop| {
            let mut display = Display::counting("tables done", run.case.objective_unit());
            display.resumed(dispatch.recorded());
            let found = score_all(dispatch, &run.case, &individuals, &mut display, stop).await;
            display.clear();
            found?;
            for part in Entry::table(&all.names, &all.rows) {
                dispatch.enter(&part)?;
            }
            Ok(())
        },
    )
}
