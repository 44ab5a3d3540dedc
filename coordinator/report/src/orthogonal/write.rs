//! Assembly of the orthogonal-array test report, and its output folder.
use super::section;
use super::subject::SweepInput;
use crate::document::Report;
use crate::folder::{ReportError, write_report};
use std::path::{Path, PathBuf};

/// Builds the report of an orthogonal-array test.
pub fn report(subject: &SweepInput<'_>) -> Report {
    let title = format!("Orthogonal test of a search on {}", subject.case.name);
    Report::new(title, &subject.origin.run, section::all(subject))
}

/// Writes the report into a folder: `report.html`, `tables.txt` and `figures/*.svg`. Returns the paths, the
/// HTML first.
///
/// # Errors
/// [`ReportError`] when a file cannot be written.
pub fn write(folder: &Path, subject: &SweepInput<'_>) -> Result<Vec<PathBuf>, ReportError> {
    write_report(folder, &report(subject))
}
