//! Report content that depends on the kind of model: figures, tables, sections and files, with the general content as
//! default.
use super::{
    chart, csv,
    data::{SimulationView, SingleRun},
    document::{Figure, Section, Table},
    folder::{ReportError, stream},
    machine_check::{ComparedChannel, MachineCheck},
    table::{agreement, ranges, simulation, value_table, work},
};
use case::kind::OtherModel;
use protocol::{case::Case, job::Curves};
use std::path::{Path, PathBuf};

/// Figures, tables, sections and files of a report that depend on the kind of model; the defaults are those of any
/// model.
pub trait ModelReport: Sync {
    /// Returns the figures of a simulation's channels.
    fn channels(&self, of: &SimulationView<'_>) -> Vec<Figure> {
        chart::channels(of)
    }

    /// Returns the figures of simulated curves that are not channels, such as internal forces.
    fn figures(&self, _of: &SimulationView<'_>) -> Vec<Figure> {
        Vec::new()
    }

    /// Returns report sections specific to the kind of model, from a simulation if there is one; `whose`
    /// names the parameter set it was run with.
    fn sections(&self, _whose: &str, _of: Option<&SimulationView<'_>>) -> Vec<Section> {
        Vec::new()
    }

    /// Returns the script of the kind of model's sections, as in [`Block::Script`](super::document::Block::Script);
    /// empty if none moves.
    fn script(&self) -> &'static str {
        ""
    }

    /// Returns the tables of one simulation: first the table of the ranges of its curves, then tables of all
    /// other numbers.
    fn tables(&self, run: &SingleRun) -> Vec<Table> {
        let mut rows = agreement(run);
        rows.extend(work(&run.curves.counters, run.curves.wall_s));
        let shown = run.shown();
        vec![
            simulation(run, ranges(&shown)),
            value_table("Agreement and work", rows),
        ]
    }

    /// Returns the reason not to use a simulation although it was completed, as a sentence; `None` if there is none.
    fn warning(&self, _run: &SingleRun) -> Option<String> {
        None
    }

    /// Returns the quantities of the machine by which an engineer judges a fit under a condition, from the
    /// channels of the condition, and from the whole simulations before and after the fit where there are any; empty
    /// where there are no such quantities.
    fn checks(
        &self,
        _case: &Case,
        _condition: usize,
        _channels: &[ComparedChannel<'_>],
        _runs: Option<[&Curves; 2]>,
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
    ) -> Result<Vec<PathBuf>, ReportError> {
        Ok(vec![curves_file(folder, runs)?])
    }
}

impl ModelReport for OtherModel {}

/// Writes the file of the channels' curves of named simulations, and returns its path.
///
/// # Errors
/// [`ReportError`] when the file cannot be written.
pub(crate) fn curves_file(
    folder: &Path,
    runs: &[(&str, SimulationView<'_>)],
) -> Result<PathBuf, ReportError> {
    stream(folder, "curves.csv", |file| csv::curves(file, runs))
}
