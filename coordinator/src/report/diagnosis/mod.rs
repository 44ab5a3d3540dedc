//! What people see of a diagnosis: the argument from where to which effect, and the proof.
mod effects;
mod text;

pub use effects::effects_toml;
pub use text::text;

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

/// Writes the report into a folder; returns the paths, what to open first.
///
/// # Errors
/// [`ReportError`] when a figure cannot be drawn or a file cannot be written.
pub fn write(folder: &Path, subject: &Subject<'_>) -> Result<Vec<PathBuf>, ReportError> {
    Ok(vec![super::write(folder, "tables.txt", &text(subject))?])
}
