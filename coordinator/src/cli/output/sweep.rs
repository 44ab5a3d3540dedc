//! Output of finished sweeps, read from their journals.
use super::{
    object::{
        orthogonal::{GridOutput, OrthogonalOutput, runs_table},
        scored::{self, IndividualsOutput},
    },
    terminal,
};
use crate::cli::{
    argument::output::Output,
    run::{
        folder::RESULT,
        opened::Run,
        orthogonal::Orthogonal,
        sweep_file::{FileContent, SweptFile},
    },
};
use report::{Report, orthogonal, sweep, text, write_report};
use search::space::Space;
use serde::Serialize;
use study::orthogonal::TestResult;

/// Name of the result table that a sweep writes into its run folder.
const TABLE: &str = "sweep.csv";

/// Reads a finished orthogonal test and builds its report.
///
/// # Errors
/// If the test is not finished, or its journal cannot be read.
pub(crate) fn test_report(run: &Run<Orthogonal>) -> anyhow::Result<Report> {
    Ok(read_test(run)?.0)
}

fn read_test(run: &Run<Orthogonal>) -> anyhow::Result<(Report, TestResult)> {
    let read = study::read_test(&run.expect_journal()?);
    let tested = read.map_err(|error| run.unreadable(error))?;
    let report = orthogonal::report(&orthogonal::SweepInput {
        case: &run.case,
        tested: &tested,
        origin: run.origin(String::new())?,
    });
    Ok((report, tested))
}

/// Reads a finished orthogonal test, writes its files and prints it.
///
/// # Errors
/// As [`test_report`], and if a file cannot be written.
pub(crate) fn show_test(run: &Run<Orthogonal>, output: Output) -> anyhow::Result<()> {
    let (report, tested) = read_test(run)?;
    let object = OrthogonalOutput::from(&tested);
    write_page(run, &report)?;
    run.folder.write_json(RESULT, &object)?;
    terminal::print(output, || text(&report, terminal::style()), &object)
}

/// Reads a finished sweep of a file and builds its report.
///
/// # Errors
/// If the sweep is not finished, or its journal cannot be read.
pub(crate) fn file_report(run: &Run<SweptFile>) -> anyhow::Result<Report> {
    Ok(read_file(run)?.report)
}

/// Result of a finished sweep of a file.
struct FileResult {
    report: Report,
    /// Result as a CSV table.
    table: String,
    object: SweepOutput,
}

/// JSON object printed by `horsehead sweep FILE`, also written as `result.json` in the run folder.
#[derive(Serialize)]
#[serde(untagged)]
enum SweepOutput {
    Grid(GridOutput),
    Individuals(IndividualsOutput),
}

fn read_file(run: &Run<SweptFile>) -> anyhow::Result<FileResult> {
    let (path, case) = (run.expect_journal()?, &run.case);
    let origin = run.origin(String::new())?;
    let unreadable = |error| run.unreadable(error);
    Ok(match &run.manifest.settings.holds {
        FileContent::Grid(searches) => {
            let tried = study::read_grid(&path).map_err(unreadable)?;
            FileResult {
                report: sweep::grid(case, &origin, &searches.factors, &tried),
                table: runs_table(&searches.factors, &tried)?,
                object: SweepOutput::Grid(GridOutput::new(&searches.factors, &tried)),
            }
        }
        FileContent::Individuals(_) => {
            let space = Space::new(&case.unknowns)?;
            let read = study::read_table(&path, |row| space.expand(row)).map_err(unreadable)?;
            let (names, rows, scores) = (&read.names, &read.rows, &read.scores);
            FileResult {
                report: sweep::individuals(case, &origin, (names, rows, scores)),
                table: scored::table(case, names, rows, scores)?,
                object: SweepOutput::Individuals(IndividualsOutput::new(case, names, rows, scores)),
            }
        }
    })
}

/// Reads a finished sweep of a file, writes its files and prints it.
///
/// # Errors
/// As [`file_report`], and if a file cannot be written.
pub(crate) fn show_file(run: &Run<SweptFile>, output: Output) -> anyhow::Result<()> {
    let FileResult {
        report,
        table,
        object,
    } = read_file(run)?;
    write_page(run, &report)?;
    run.folder.write(TABLE, &table)?;
    run.folder.write_json(RESULT, &object)?;
    let words = || match run.manifest.settings.holds {
        FileContent::Grid(_) => text(&report, terminal::style()),
        // for other programs
        FileContent::Individuals(_) => table,
    };
    terminal::print(output, words, &object)
}

fn write_page<S>(run: &Run<S>, report: &Report) -> anyhow::Result<()> {
    let files = write_report(run.folder.path(), report)?;
    let page = files.first().map(|page| page.display().to_string());
    terminal::tell(&format!("open {}", page.unwrap_or_default()));
    Ok(())
}
