//! Output of an assessment: files in its run folder, and text or JSON on standard output.
use super::terminal;
use crate::cli::argument::output::Output;
use report::{MachineAssessment, text, write_report};
use run::{folder::RESULT, manifest::RunIdentity, message, opened::Run};
use serde::Serialize;

/// Writes the report of an assessment with its title, a CSV file with its name and text, and the output object into the run
/// folder, and prints the result.
pub(crate) fn show<S: RunIdentity>(
    run: &Run<S>,
    (title, assessment): (String, &MachineAssessment),
    (csv, rows): (&str, &str),
    object: &impl Serialize,
    output: Output,
) -> anyhow::Result<()> {
    let folder = run.folder.path();
    let report = assessment.report(title, &folder.display().to_string());
    for path in write_report(folder, &report)?.iter().take(1) {
        message::print(&format!("open {}", path.display()));
    }
    report::folder::write(folder, csv, rows)?;
    run.folder.write_assessment(assessment)?;
    run.folder.write_json(RESULT, object)?;
    // the tables have them
    if output == Output::Json {
        message::print_notes(&assessment.notes);
    }
    terminal::print(output, || text(&report, terminal::style()), object)
}
