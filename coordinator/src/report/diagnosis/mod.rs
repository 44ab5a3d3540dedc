//! What people see of a diagnosis: the argument from where to which effect, and the proof.
//!
//! One page that reads from top to bottom: the verdict, where the curves part, what was suspected,
//! what is added, what that shows, how sure it is, how it was made. Sections are in a catalogue; none
//! knows its neighbours. Everything is the diagnosis' own number: nothing is computed again here but
//! the paper's two error measures.
mod csv;
mod effects;
mod judgement;
mod section;
mod shown;
mod table;
mod text;
mod words;

pub use effects::effects_toml;
pub use text::text;

use super::chart::Figure;
use super::html::{self, Part};
use super::{Provenance, ReportError};
use crate::study::Diagnosed;
use discrepancy::record::Record;
use protocol::announce::EffectDescriptor;
use protocol::case::Case;
use std::path::{Path, PathBuf};

/// A finished diagnosis with everything that its report names.
#[derive(Clone, Debug)]
pub struct Subject<'a> {
    /// The case.
    pub case: &'a Case,
    /// Its records, cycle by cycle.
    pub records: &'a [Record],
    /// Effects that were considered, forces without a cause included.
    pub library: &'a [EffectDescriptor],
    /// The answer, with the cost of its stages.
    pub diagnosed: &'a Diagnosed,
    /// How it was made.
    pub provenance: Provenance,
    /// Remarks about case and records.
    pub notes: &'a [String],
    /// Wall time of all sessions (s).
    pub wall_s: f64,
}

/// The report as one HTML page.
///
/// # Errors
/// [`ReportError::Chart`] when a figure cannot be drawn.
pub fn page(subject: &Subject<'_>) -> Result<String, ReportError> {
    let figures = section::figures(subject)?;
    Ok(assembled(subject, &figures))
}

fn assembled(subject: &Subject<'_>, figures: &section::Figures) -> String {
    let rendered = section::SECTIONS.iter().filter_map(|section| {
        Some(Part {
            id: section.id,
            title: section.title,
            body: (section.render)(subject, figures)?,
        })
    });
    let parts: Vec<Part> = rendered.collect();
    let title = format!("Diagnosis of {}", subject.case.name);
    html::assemble(&title, &subject.provenance.run, &parts)
}

/// Writes the report into a folder, which is made if it does not exist: `report.html`, `tables.txt`,
/// `curves.csv`, `suspects.csv` and `figures/*.svg`. Returns the paths, the HTML first.
///
/// # Errors
/// [`ReportError`] when a figure cannot be drawn or a file cannot be written.
pub fn write(folder: &Path, subject: &Subject<'_>) -> Result<Vec<PathBuf>, ReportError> {
    let figures = section::figures(subject)?;
    let mut written = vec![super::write(
        folder,
        "report.html",
        &assembled(subject, &figures),
    )?];
    written.push(super::write(folder, "tables.txt", &text(subject))?);
    written.push(super::stream(folder, "curves.csv", |file| {
        csv::curves(file, subject)
    })?);
    written.push(super::stream(folder, "suspects.csv", |file| {
        csv::suspects(file, subject)
    })?);
    let all: Vec<Figure> = figures.all().cloned().collect();
    written.extend(super::write_figures(folder, &all)?);
    Ok(written)
}
