//! Assembly of the diagnosis report, and its output folder.
use super::section::SECTIONS;
use super::subject::DiagnosisInput;
use super::{csv, words};
use crate::ReportError;
use crate::assessment::MachineAssessment;
use crate::document::{Report, Section};
use crate::folder::{stream, write_report};
use std::path::{Path, PathBuf};

/// Builds the report of a diagnosis.
pub fn report(subject: &DiagnosisInput<'_>) -> Report {
    let title = format!("Diagnosis of {}", subject.case.name);
    let mut sections: Vec<Section> = SECTIONS.iter().map(|section| section(subject)).collect();
    // before the provenance
    let assessed = subject.assessments.iter().map(MachineAssessment::section);
    let origin = sections.len() - 1;
    sections.splice(origin..origin, assessed);
    Report {
        outcome: words::outcome(subject.diagnosis()),
        ..Report::new(title, &subject.origin.run, sections)
    }
}

/// Writes the diagnosis report into a folder, creating it if needed: `report.html`, `tables.txt`,
/// `figures/*.svg`, `curves.csv` and `suspects.csv`. Returns the paths, the HTML first.
///
/// # Errors
/// [`ReportError`] when a file cannot be written.
pub fn write(folder: &Path, subject: &DiagnosisInput<'_>) -> Result<Vec<PathBuf>, ReportError> {
    let mut written = write_report(folder, &report(subject))?;
    written.push(stream(folder, "curves.csv", |file| {
        csv::curves(file, subject)
    })?);
    written.push(stream(folder, "suspects.csv", |file| {
        csv::suspects(file, subject)
    })?);
    Ok(written)
}
