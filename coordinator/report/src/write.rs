//! Assembly and output of calibration and simulation reports with their data.
use super::csv;
use super::data::{Calibration, ConditionResult, SingleRun};
use super::document::{Block, Report, SCRIPT, Section, Table, TerminalStyle, section_text};
use super::folder::{ReportError, stream, write_report};
use super::machine_check::MachineCheck;
use super::{kind, section, table, words};
use protocol::case::Case;
use std::path::{Path, PathBuf};

/// Builds the report of a calibration.
pub fn calibration(calibration: &Calibration) -> Report {
    let title = format!("Calibration of {}", calibration.case.name);
    let sections = section::calibration(calibration);
    Report::new(title, &calibration.origin.run, sections)
}

/// Returns the script of the pages of a dashboard: that of every page, and those of all kinds of model.
pub fn script() -> String {
    let mut script = SCRIPT.to_owned();
    script.extend(kind::scripts());
    script
}

/// Builds the sections of a calibration that goes on, as far as there are data for them.
pub fn running_calibration(calibration: &Calibration) -> Vec<Section> {
    section::running_calibration(calibration)
}

/// Builds the blocks that show one individual of a calibration, number `number`, beside the recommended one: its
/// values, and its measured and simulated curves.
pub fn individual(
    case: &Case,
    (number, genes): (u64, &[f64]),
    conditions: &[ConditionResult],
) -> Section {
    section::individual(case, (number, genes), conditions)
}

/// Renders the outcome of a calibration in words and the tables of its parameters, errors and machine quantities for
/// a terminal.
pub fn parameters(calibration: &Calibration, style: TerminalStyle) -> String {
    let mut section = section::parameters(calibration);
    let checks = section::checks(calibration);
    let machine = section::machine_table(&checks, ["recommended", "optimised"]);
    section.blocks.extend(machine.map(Block::Table));
    section
        .blocks
        .splice(..0, section::headline(calibration, &checks));
    section_text(&section, style)
}

/// Renders quantities of the machine with the recommended and the optimised parameters, and their flags, for a
/// terminal.
pub fn machine(checks: &[MachineCheck], style: TerminalStyle) -> String {
    section_text(&section::machine(checks), style)
}

/// States that the search found fits of other families with nearly the same objective; `None` if it found none.
pub fn rivals(calibration: &Calibration) -> Option<String> {
    words::rivals(calibration)
}

/// Describes how far a calibration's residual exceeds the measurement noise; `None` where the residual is at
/// noise level.
pub fn structure(calibration: &Calibration) -> Option<String> {
    words::model_error(calibration)
}

/// Builds the report of one simulation.
pub fn simulation(run: &SingleRun) -> Report {
    let title = format!("Simulation of {}", run.case.name);
    Report::new(title, &run.origin.run, section::simulation(run))
}

/// Returns the table of the ranges of a simulation's curves, with the reason not to use it as a note if there is one.
pub fn ranges(run: &SingleRun) -> Option<Table> {
    let kind = kind::of(&run.case);
    let table = kind.tables(run).into_iter().next()?;
    Some(table.with_notes(kind.warning(run)))
}

/// Builds the table of a simulation's agreement with its measured record, if there is one.
pub fn agreement(run: &SingleRun) -> Option<Table> {
    let mut rows = table::agreement(run);
    // its heading is the title here
    (!rows.is_empty()).then(|| rows.remove(0))?;
    Some(table::value_table("Against the record", rows))
}

/// Writes the report of a calibration into a folder, creating it if needed: `report.html`, `tables.txt`,
/// `figures/*.svg` and the data files of its kind of model. Returns the paths, the HTML first.
///
/// # Errors
/// [`ReportError`] when a file cannot be written.
pub fn write_calibration(folder: &Path, of: &Calibration) -> Result<Vec<PathBuf>, ReportError> {
    let mut written = write_report(folder, &calibration(of))?;
    written.extend(kind::of(&of.case).files(folder, &of.shown())?);
    Ok(written)
}

/// Writes the report of one simulation into a folder, creating it if needed: `report.html`, `tables.txt`,
/// `figures/*.svg`, the data files of its kind of model and, if requested, the derivatives. Returns the
/// paths, the HTML first.
///
/// # Errors
/// [`ReportError`] when a file cannot be written.
pub fn write_simulation(folder: &Path, run: &SingleRun) -> Result<Vec<PathBuf>, ReportError> {
    let mut written = write_report(folder, &simulation(run))?;
    let alone = [(run.genes_name.as_str(), run.shown())];
    written.extend(kind::of(&run.case).files(folder, &alone)?);
    if !run.derived.is_empty() {
        let derivatives = |file| csv::derivatives(file, run);
        written.push(stream(folder, "derivatives.csv", derivatives)?);
    }
    Ok(written)
}
