//! Output of a finished identifiability analysis: files in the run folder, and text or JSON on standard
//! output.
use super::{object::identification::object, terminal};
use crate::cli::argument::output::Output;
use ::report::{identification as report, text};
use case::CaseEffect;
use run::{
    folder::RESULT,
    identification::{IdentificationRun, recorded, report_input},
    message,
};

/// Reads the result of a finished identifiability analysis from its run folder, writes its files and prints it.
///
/// # Errors
/// As [`recorded`], and if a file cannot be written.
pub(crate) fn show(run: &IdentificationRun, wall_s: f64, output: Output) -> anyhow::Result<()> {
    let found = recorded(run)?;
    let subject = report_input(run, &found, wall_s)?;
    let about = format!("Parameters of {}", run.folder.path().display());
    run.folder.write_genes(
        &run.case,
        &found.identified.genes,
        &CaseEffect::all_of(&run.case),
        &about,
    )?;
    let files = report::write(run.folder.path(), &subject)?;
    for page in files.iter().take(1) {
        message::print(&format!("open {}", page.display()));
    }
    let object = object(&subject, found.simulations);
    run.folder.write_json(RESULT, &object)?;
    let tables = || text(&report::report(&subject), terminal::style());
    terminal::print(output, tables, &object)
}
