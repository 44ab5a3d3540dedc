//! Report content specific to a kind of model, in addition to the general content.
use super::data::{SimulationView, SingleRun};
use super::document::{Figure, Section, Table};
use super::folder::ReportError;
use super::machine_check::{ComparedChannel, MachineCheck};
use protocol::case::{Case, Unknown};
use std::path::{Path, PathBuf};

/// Figures, tables, sections and files of a report that depend on the kind of model.
pub trait ModelReport: Sync {
    /// Returns the figures of a simulation's channels.
    fn channels(&self, of: &SimulationView<'_>) -> Vec<Figure>;

    /// Returns the figures of simulated curves that are not channels, such as internal forces.
    fn figures(&self, of: &SimulationView<'_>) -> Vec<Figure>;

    /// Returns report sections specific to the kind of model, from a simulation if there is one; `whose`
    /// names the parameter set it was run with.
    fn sections(&self, whose: &str, of: Option<&SimulationView<'_>>) -> Vec<Section>;

    /// Returns the script of the kind of model's sections, as in [`Block::Script`](super::document::Block::Script);
    /// empty if none moves.
    fn script(&self) -> &'static str {
        ""
    }

    /// Returns the description of the abscissas' origin, such as " from bottom dead centre", appended to an
    /// abscissa's name in axis titles; empty where none is needed.
    fn zero(&self) -> &'static str;

    /// Returns the title of the group of table rows to which an unknown belongs; parameters of effects have a
    /// group of their own.
    fn group(&self, unknown: &Unknown) -> &'static str;

    /// Returns the tables of one simulation: first the table of the ranges of its curves, then tables of all
    /// other numbers.
    fn tables(&self, run: &SingleRun) -> Vec<Table>;

    /// Returns the quantities of the machine by which an engineer judges a fit under a condition, from the
    /// channels of the condition; empty where there are none.
    fn checks(
        &self,
        _case: &Case,
        _condition: usize,
        _channels: &[ComparedChannel<'_>],
    ) -> Vec<MachineCheck> {
        Vec::new()
    }

    /// Writes files specific to the kind of model with the data behind the figures of named simulations.
    /// Returns the paths.
    ///
    /// # Errors
    /// [`ReportError`] when a file cannot be written.
    fn files(
        &self,
        folder: &Path,
        runs: &[(&str, SimulationView<'_>)],
    ) -> Result<Vec<PathBuf>, ReportError>;

    /// Returns the repetition frequency of a periodic process under a condition \[Hz\]; `None` where nothing
    /// is periodic.
    fn frequency_hz(&self, case: &Case, condition: usize) -> Option<f64>;
}
