//! Assembly of the orthogonal-array test report.
use super::section;
use super::subject::SweepInput;
use crate::document::Report;

/// Builds the report of an orthogonal-array test.
pub fn report(subject: &SweepInput<'_>) -> Report {
    let title = format!("Orthogonal test of a search on {}", subject.case.name);
    Report::new(title, &subject.origin.run, section::all(subject))
}
