//! What one kind of model shows in a report beside what all of them show.
use super::data::{Shown, SingleRun};
use super::document::{Figure, Section, Table};
use super::folder::ReportError;
use protocol::case::{Case, Unknown};
use std::path::{Path, PathBuf};

/// A kind of model as reports show it.
pub trait Drawing: Sync {
    /// Its channels, drawn from all that was simulated.
    fn channels(&self, of: &Shown<'_>) -> Vec<Figure>;

    /// Curves of what no channel holds.
    fn figures(&self, of: &Shown<'_>) -> Vec<Figure>;

    /// Sections of its own, from a simulation if there is one, with the parameters that it is named
    /// after.
    fn sections(&self, whose: &str, of: Option<&Shown<'_>>) -> Vec<Section>;

    /// Where its abscissas begin, behind their name; empty where that needs no words.
    fn zero(&self) -> &'static str;

    /// The group of a table that an unknown stands in; parameters of effects have their own.
    fn group(&self, unknown: &Unknown) -> &'static str;

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
