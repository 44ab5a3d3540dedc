//! What one kind of model shows in a report beside what all of them show.
use super::data::{Shown, SingleRun};
use super::document::{Figure, Table};
use super::folder::ReportError;
use maud::Markup;
use protocol::case::Case;
use std::path::{Path, PathBuf};

/// A kind of model as reports show it.
pub(crate) trait Drawing: Sync {
    /// The kind, as cases name it.
    fn kind(&self) -> &'static str;

    /// Its channels, drawn from all that was simulated.
    fn channels(&self, of: &Shown<'_>) -> Figure;

    /// Curves of what no channel holds.
    fn figures(&self, of: &Shown<'_>) -> Vec<Figure>;

    /// The model in motion; none where the simulation left nothing to move.
    fn moving(&self, of: &Shown<'_>) -> Option<Markup>;

    /// One simulation in numbers: first the ranges of its curves, then everything else.
    fn tables(&self, run: &SingleRun) -> Vec<Table>;

    /// Writes the numbers behind the figures of named simulations. Returns the paths.
    ///
    /// # Errors
    /// [`ReportError`] when a file cannot be written.
    fn files(&self, folder: &Path, runs: &[(&str, Shown<'_>)])
    -> Result<Vec<PathBuf>, ReportError>;

    /// How often a second what is periodic repeats under a condition \[Hz\].
    fn frequency_hz(&self, case: &Case, condition: usize) -> Option<f64>;
}
