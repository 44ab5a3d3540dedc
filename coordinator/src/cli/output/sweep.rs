//! Output of finished sweeps: files in the run folder, and text or JSON on standard output.
use super::{
    object::{
        orthogonal::{GridOutput, OrthogonalOutput, runs_table},
        scored::{self, IndividualsOutput},
    },
    terminal,
};
use crate::cli::argument::output::Output;
use report::{Report, text, write_report};
use run::{
    folder::RESULT,
    message,
    opened::Run,
    orthogonal::{self, Orthogonal},
    sweep_file::{self, SweepResult, SweptFile},
};
use study::RecordedTable;

/// Name of the result table that a sweep writes into its run folder.
const TABLE: &str = "sweep.csv";

/// Reads a finished orthogonal test, writes its files and prints it.
///
/// # Errors
/// As [`orthogonal::recorded`], and if a file cannot be written.
pub(crate) fn show_test(run: &Run<Orthogonal>, output: Output) -> anyhow::Result<()> {
    let tested = orthogonal::recorded(run)?;
    let report = orthogonal::report(run, &tested)?;
    let object = OrthogonalOutput::from(&tested);
    write_page(run, &report)?;
    run.folder.write_json(RESULT, &object)?;
    terminal::print(output, || text(&report, terminal::style()), &object)
}

/// Reads a finished sweep of a file, writes its files and prints it.
///
/// # Errors
/// As [`sweep_file::recorded`], and if a file cannot be written.
pub(crate) fn show_file(run: &Run<SweptFile>, output: Output) -> anyhow::Result<()> {
    let result = sweep_file::recorded(run)?;
    let report = sweep_file::report(run, &result)?;
    write_page(run, &report)?;
    match result {
        SweepResult::Grid(tried) => {
            let factors = run.manifest.settings.factors();
            let object = GridOutput::new(factors, &tried);
            run.folder.write(TABLE, runs_table(factors, &tried)?)?;
            run.folder.write_json(RESULT, &object)?;
            terminal::print(output, || text(&report, terminal::style()), &object)
        }
        SweepResult::Individuals(RecordedTable {
            names,
            rows,
            scores,
        }) => {
            let table = scored::table(&run.case, &names, &rows, &scores)?;
            let object = IndividualsOutput::new(&run.case, &names, &rows, &scores);
            run.folder.write(TABLE, &table)?;
            run.folder.write_json(RESULT, &object)?;
            // for other programs
            terminal::print(output, || table, &object)
        }
    }
}

fn write_page<S>(run: &Run<S>, report: &Report) -> anyhow::Result<()> {
    let files = write_report(run.folder.path(), report)?;
    let page = files.first().map(|page| page.display().to_string());
    message::print(&format!("open {}", page.unwrap_or_default()));
    Ok(())
}
