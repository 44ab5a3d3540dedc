//! The report of an orthogonal test: what is best, whether chance could have said the same, every run.
//!
//! Knows the test as plain data, not who ran it.
mod section;

use super::data::Origin;
use super::document::Report;
use super::folder::{ReportError, write_report};
use crate::orthogonal::Tested;
use protocol::case::Case;
use std::path::{Path, PathBuf};

pub(crate) use section::runs;

/// What a report of a test is about.
pub(crate) struct Subject<'a> {
    /// The case that was searched.
    pub(crate) case: &'a Case,
    /// The test.
    pub(crate) tested: &'a Tested,
    /// How it was made.
    pub(crate) origin: Origin,
}

/// The report.
pub(crate) fn report(subject: &Subject<'_>) -> Report {
    let title = format!("Orthogonal test of a search on {}", subject.case.name);
    Report::new(title, &subject.origin.run, section::all(subject))
}

/// Writes `report.html`, `tables.txt` and `figures/*.svg` into a folder. Returns the paths, the HTML first.
///
/// # Errors
/// [`ReportError`] when a file cannot be written.
pub(crate) fn write(folder: &Path, subject: &Subject<'_>) -> Result<Vec<PathBuf>, ReportError> {
    write_report(folder, &report(subject))
}
