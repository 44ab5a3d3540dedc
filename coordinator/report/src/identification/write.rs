//! Assembly of the identification report, and its output folder.
use super::csv;
use super::section::SECTIONS;
use super::subject::IdentificationInput;
use crate::ReportError;
use crate::document::Report;
use crate::folder::{stream, write_report};
use std::path::{Path, PathBuf};

/// Builds the report of an identification.
pub fn report(subject: &IdentificationInput<'_>) -> Report {
    let title = format!("Identification of {}", subject.case.name);
    let sections = SECTIONS.iter().map(|section| section(subject));
    Report::new(title, &subject.origin.run, sections)
}

/// Writes the identification report into a folder, creating it if needed: `report.html`, `tables.txt`,
/// `figures/*.svg`, `profiles.csv` and `prediction.csv`. Returns the paths, the HTML first.
///
/// # Errors
/// [`ReportError`] when a file cannot be written.
pub fn write(
    folder: &Path,
    subject: &IdentificationInput<'_>,
) -> Result<Vec<PathBuf>, ReportError> {
    let mut written = write_report(folder, &report(subject))?;
    written.push(stream(folder, "profiles.csv", |file| {
        csv::profiles(file, subject)
    })?);
    written.push(stream(folder, "prediction.csv", |file| {
        csv::bands(file, subject)
    })?);
    Ok(written)
}
