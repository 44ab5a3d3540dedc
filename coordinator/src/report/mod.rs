//! What people see of a finished run: tables, figures, an HTML report and the data behind it.
//!
//! Takes plain data ([`Calibration`], [`SingleRun`]) and returns text, or writes a folder of files.
//! The same data give the same bytes: nothing here reads a clock, a journal or the network.
mod animation;
pub mod chart;
mod color;
pub mod csv;
mod data;
pub mod diagnosis;
pub mod html;
mod number;
mod section;
pub mod table;
pub mod vtu;
pub mod words;

pub use data::{
    Calibration, ConditionResult, HistoryPoint, Individual, Provenance, Run, SingleRun, WorkerUse,
};

use crate::study::{BoxPoint, WorkPrecision};
use protocol::case::Case;
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

/// A report could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A figure could not be drawn.
    #[error(transparent)]
    Chart(#[from] chart::ChartError),
    /// A file of the report could not be written.
    #[error("cannot write {path}: {source}", path = path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A table of numbers could not be written.
    #[error("cannot write {path}: {source}", path = path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// Why.
        source: ::csv::Error,
    },
}

/// Writes the report of a calibration into a folder, which is made if it does not exist:
/// `report.html`, `curves.csv`, `tables.txt` and `figures/*.svg`. Returns the paths,
/// the HTML first.
///
/// # Errors
/// [`ReportError`] when a figure cannot be drawn or a file cannot be written.
pub fn write_calibration(
    folder: &Path,
    calibration: &Calibration,
) -> Result<Vec<PathBuf>, ReportError> {
    let case = &calibration.case;
    let mut written = vec![write(
        folder,
        "report.html",
        &html::calibration(calibration)?,
    )?];
    written.push(stream(folder, "curves.csv", |file| {
        csv::curves(file, case, &calibration.conditions)
    })?);
    let mut tables = table::text(&table::table_3(calibration), false);
    let mut figures = Vec::new();
    for result in &calibration.conditions {
        if result.condition != case.objective.condition {
            tables.push('\n');
            tables.push_str(&table::text(&table::table_4(case, result), false));
        }
        figures.extend(chart::overlays(case, result)?);
    }
    written.push(write(folder, "tables.txt", &tables)?);
    if !calibration.history.is_empty() {
        let recommended = calibration.calibrated().and_then(words::complete_objective);
        figures.push(chart::convergence(&calibration.history, recommended)?);
        figures.push(chart::genes(calibration)?);
    }
    if let Some(result) = calibration.calibrated() {
        let simulation = &result.optimised.simulation;
        figures.extend(chart::machine_curves(case, result.condition, simulation)?);
    }
    figures.extend(chart::workers(&calibration.workers)?);
    written.extend(write_figures(folder, &figures)?);
    Ok(written)
}

/// Writes the report of one simulation into a folder, which is made if it does not exist:
/// `report.html`, `curves.csv`, `ropes.csv`, `tables.txt` and `figures/*.svg`. Returns the paths, the
/// HTML first.
///
/// # Errors
/// [`ReportError`] when a figure cannot be drawn or a file cannot be written.
pub fn write_simulation(folder: &Path, run: &SingleRun) -> Result<Vec<PathBuf>, ReportError> {
    let mut written = vec![write(folder, "report.html", &html::simulation(run)?)?];
    written.push(stream(folder, "curves.csv", |file| {
        csv::single_curves(file, run)
    })?);
    written.push(stream(folder, "ropes.csv", |file| {
        csv::ropes(file, &run.simulation)
    })?);
    let tables = [
        table::simulation(run),
        table::balance(run),
        table::genes(run),
    ]
    .map(|table| table::text(&table, false))
    .join("\n");
    written.push(write(folder, "tables.txt", &tables)?);
    let figures = chart::simulation(&run.case, run.condition, &run.simulation)?;
    written.extend(write_figures(folder, &figures)?);
    Ok(written)
}

/// Writes a comparison of methods of integration into a folder, which is made if it does not exist:
/// `integrators.svg` and `integrators.csv`. Returns the paths.
///
/// # Errors
/// [`ReportError`] when the figure cannot be drawn or a file cannot be written.
pub fn write_work_precision(
    folder: &Path,
    all: &WorkPrecision,
) -> Result<Vec<PathBuf>, ReportError> {
    let figure = chart::work_precision(all)?;
    let name = format!("{}.svg", file_stem(&figure.name));
    Ok(vec![
        write(folder, &name, &figure.svg)?,
        stream(folder, "integrators.csv", |file| {
            csv::work_precision(file, all)
        })?,
    ])
}

/// Writes `head_modes.svg` into a folder, which is made if it does not exist. Returns its path.
///
/// # Errors
/// [`ReportError`] when the figure cannot be drawn or the file cannot be written.
pub fn write_head_modes(
    folder: &Path,
    picture: &chart::HeadPicture<'_>,
) -> Result<PathBuf, ReportError> {
    let figure = chart::head_modes(picture)?;
    write(folder, &format!("{}.svg", figure.name), &figure.svg)
}

/// Writes `box.csv` into a folder, which is made if it does not exist: individuals of the box of genes
/// and how they ended. Returns its path.
///
/// # Errors
/// [`ReportError`] when the file cannot be written.
pub fn write_box(folder: &Path, case: &Case, points: &[BoxPoint]) -> Result<PathBuf, ReportError> {
    stream(folder, "box.csv", |file| csv::whole_box(file, case, points))
}

fn write_figures(folder: &Path, figures: &[chart::Figure]) -> Result<Vec<PathBuf>, ReportError> {
    let folder = folder.join("figures");
    let mut written = Vec::new();
    for figure in figures {
        let name = format!("{}.svg", file_stem(&figure.name));
        written.push(write(&folder, &name, &figure.svg)?);
    }
    Ok(written)
}

/// A name as part of a path: nothing but letters, digits, `-` and `_`.
fn file_stem(name: &str) -> String {
    name.chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() || c == '-' {
                c
            } else {
                '_'
            }
        })
        .collect()
}

fn write(folder: &Path, name: &str, text: &str) -> Result<PathBuf, ReportError> {
    let path = folder.join(name);
    let result = fs::create_dir_all(folder).and_then(|()| fs::write(&path, text));
    match result {
        Ok(()) => Ok(path),
        Err(source) => Err(ReportError::Write { path, source }),
    }
}

fn stream(
    folder: &Path,
    name: &str,
    fill: impl FnOnce(BufWriter<File>) -> Result<(), ::csv::Error>,
) -> Result<PathBuf, ReportError> {
    let path = folder.join(name);
    match File::create(&path) {
        Ok(file) => match fill(BufWriter::new(file)) {
            Ok(()) => Ok(path),
            Err(source) => Err(ReportError::Csv { path, source }),
        },
        Err(source) => Err(ReportError::Write { path, source }),
    }
}
