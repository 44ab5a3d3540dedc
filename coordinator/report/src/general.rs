//! Report content common to models of any kind: figures and tables of the channels.
use super::data::{SimulationView, SingleRun};
use super::document::{Figure, Section, Table};
use super::drawing::ModelReport;
use super::folder::{ReportError, stream};
use super::table::{agreement, ranges, simulation, value_table, work};
use super::{chart, csv};
use protocol::case::{Case, Unknown};
use std::path::{Path, PathBuf};

/// Report content for kinds of model without report content of their own.
pub struct GenericReport;

impl ModelReport for GenericReport {
    fn channels(&self, of: &SimulationView<'_>) -> Vec<Figure> {
        chart::channels(of, self.zero())
    }

    fn figures(&self, _of: &SimulationView<'_>) -> Vec<Figure> {
        Vec::new()
    }

    fn sections(&self, _whose: &str, _of: Option<&SimulationView<'_>>) -> Vec<Section> {
        Vec::new()
    }

    fn zero(&self) -> &'static str {
        ""
    }

    fn group(&self, _unknown: &Unknown) -> &'static str {
        "Unknowns"
    }

    fn tables(&self, run: &SingleRun) -> Vec<Table> {
        let mut rows = agreement(run);
        rows.extend(work(&run.curves.counters, run.curves.wall_s));
        let shown = run.shown();
        vec![
            simulation(run, ranges(&shown)),
            value_table("Agreement and work", rows),
        ]
    }

    fn files(
        &self,
        folder: &Path,
        runs: &[(&str, SimulationView<'_>)],
    ) -> Result<Vec<PathBuf>, ReportError> {
        Ok(vec![stream(folder, "curves.csv", |file| {
            csv::curves(file, runs)
        })?])
    }

    fn frequency_hz(&self, _case: &Case, _condition: usize) -> Option<f64> {
        None
    }
}
