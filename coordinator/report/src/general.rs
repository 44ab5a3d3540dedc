//! Report content for models of any kind: the channels.
use super::data::{Shown, SingleRun};
use super::document::{Figure, Section, Table};
use super::drawing::Drawing;
use super::folder::{ReportError, stream};
use super::table::{agreement, ranges, simulation, sums, work};
use super::{chart, csv};
use protocol::case::{Case, Unknown};
use std::path::{Path, PathBuf};

/// Model of a kind without specific report content.
pub struct General;

impl Drawing for General {
    fn channels(&self, of: &Shown<'_>) -> Vec<Figure> {
        chart::channels(of, self.zero())
    }

    fn figures(&self, _of: &Shown<'_>) -> Vec<Figure> {
        Vec::new()
    }

    fn sections(&self, _whose: &str, _of: Option<&Shown<'_>>) -> Vec<Section> {
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
            sums("Agreement and work", rows),
        ]
    }

    fn files(
        &self,
        folder: &Path,
        runs: &[(&str, Shown<'_>)],
    ) -> Result<Vec<PathBuf>, ReportError> {
        Ok(vec![stream(folder, "curves.csv", |file| {
            csv::curves(file, runs)
        })?])
    }

    fn frequency_hz(&self, _case: &Case, _condition: usize) -> Option<f64> {
        None
    }
}
