//! What commands write: reports of calibrations and simulations with the data behind them.
use super::data::{Calibration, SingleRun};
use super::document::{Report, section_text};
use super::folder::{ReportError, stream, svg_name, write, write_report};
use super::{chart, csv, section};
use std::path::{Path, PathBuf};

/// The report of a calibration.
pub fn calibration(calibration: &Calibration) -> Report {
    let title = format!("Calibration of {}", calibration.case.name);
    let sections = section::CALIBRATION.iter().map(|one| one(calibration));
    Report::new(title, &calibration.origin.run, sections)
}

/// Parameters and errors of a calibration, for a terminal.
pub fn parameters(calibration: &Calibration, styled: bool) -> String {
    section_text(&section::parameters(calibration), styled)
}

/// The report of one simulation.
pub fn simulation(run: &SingleRun) -> Report {
    let title = format!("Simulation of {}", run.case.name);
    let sections = section::SIMULATION.iter().map(|one| one(run));
    Report::new(title, &run.origin.run, sections)
}

/// Writes the report of a calibration into a folder, which is made if it does not exist:
/// `report.html`, `tables.txt`, `figures/*.svg` and `curves.csv`. Returns the paths, the HTML first.
///
/// # Errors
/// [`ReportError`] when a file cannot be written.
pub fn write_calibration(folder: &Path, of: &Calibration) -> Result<Vec<PathBuf>, ReportError> {
    let mut written = write_report(folder, &calibration(of))?;
    written.push(stream(folder, "curves.csv", |file| {
        csv::curves(file, &of.case, &of.conditions)
    })?);
    Ok(written)
}

/// Writes the report of one simulation into a folder, which is made if it does not exist:
/// `report.html`, `tables.txt`, `figures/*.svg`, `curves.csv` and `ropes.csv`. Returns the paths, the
/// HTML first.
///
/// # Errors
/// [`ReportError`] when a file cannot be written.
pub fn write_simulation(folder: &Path, run: &SingleRun) -> Result<Vec<PathBuf>, ReportError> {
    let mut written = write_report(folder, &simulation(run))?;
    written.push(stream(folder, "curves.csv", |file| {
        csv::single_curves(file, run)
    })?);
    written.push(stream(folder, "ropes.csv", |file| {
        csv::ropes(file, &run.simulation)
    })?);
    Ok(written)
}

/// Writes `head_modes.svg` into a folder, which is made if it does not exist. Returns its path.
///
/// # Errors
/// [`ReportError`] when the file cannot be written.
pub fn write_head_modes(
    folder: &Path,
    picture: &chart::HeadPicture<'_>,
) -> Result<PathBuf, ReportError> {
    let figure = chart::head_modes(picture);
    write(folder, &svg_name(&figure.name), &figure.svg)
}
