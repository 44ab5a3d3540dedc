//! Output folder of a report: `report.html`, `tables.txt`, `figures/*.svg`, and data as CSV.
use super::document::{Report, TerminalStyle, page, text};
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use support::atomic_file::{Draft, replace};

/// Error when a report cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// Error when writing a text, page or figure file.
    #[error("cannot write {path}: {source}", path = path.display())]
    Write {
        /// Path of the file or folder.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// Error when writing a CSV file.
    #[error("cannot write {path}: {source}", path = path.display())]
    Csv {
        /// Path of the file.
        path: PathBuf,
        /// Error of the CSV writer.
        source: ::csv::Error,
    },
}

/// Writes page, text and figures into a folder, creating it if needed. Returns the paths, the HTML first.
///
/// # Errors
/// [`ReportError::Write`] when a file cannot be written.
pub fn write_report(folder: &Path, report: &Report) -> Result<Vec<PathBuf>, ReportError> {
    let mut written = vec![
        write(folder, "report.html", &page(report))?,
        write(
            folder,
            "tables.txt",
            &text(report, TerminalStyle::default()),
        )?,
    ];
    let figures = folder.join("figures");
    for figure in report.figures() {
        written.push(write(&figures, &svg_name(&figure.name), &figure.svg)?);
    }
    Ok(written)
}

/// Returns the file name of a figure; characters other than ASCII letters, digits and `-` become `_`.
pub fn svg_name(figure: &str) -> String {
    let keep = |c: char| c.is_ascii_alphanumeric() || c == '-';
    let stem = figure.chars().map(|c| if keep(c) { c } else { '_' });
    format!("{}.svg", stem.collect::<String>())
}

/// Writes a text file atomically, creating the folder if needed.
///
/// # Errors
/// [`ReportError::Write`] when the file cannot be written.
pub fn write(folder: &Path, name: &str, text: &str) -> Result<PathBuf, ReportError> {
    let path = folder.join(name);
    let result = fs::create_dir_all(folder).and_then(|()| replace(&path, text.as_bytes()));
    match result {
        Ok(()) => Ok(path),
        Err(source) => Err(ReportError::Write { path, source }),
    }
}

/// Writes a CSV file atomically.
///
/// # Errors
/// [`ReportError`] when the file cannot be written.
pub fn stream(
    folder: &Path,
    name: &str,
    fill: impl FnOnce(BufWriter<File>) -> Result<(), ::csv::Error>,
) -> Result<PathBuf, ReportError> {
    let path = folder.join(name);
    let draft = Draft::filled(&path, |file| fill(BufWriter::new(file)));
    let written = draft.and_then(|draft| Ok(draft.publish()?));
    match written {
        Ok(()) => Ok(path),
        Err(source) => Err(ReportError::Csv { path, source }),
    }
}
