//! Report of models that are external commands: the general report, with PEST's residual file of the
//! calibration for programs that read it.
use crate::{
    Figure, GenericReport, ModelReport, ReportError, Section, SimulationView, SingleRun, Table,
    folder::stream,
};
use exchange::pest::{self, ReiRow};
use protocol::{
    case::{Case, Unknown},
    external::{ChannelSource, External},
};
use std::{
    io::Write as _,
    path::{Path, PathBuf},
};

/// Report content of external-command models: the general content, with PEST's residual files added.
pub(crate) struct ExternalModelReport;

impl ModelReport for ExternalModelReport {
    fn channels(&self, of: &SimulationView<'_>) -> Vec<Figure> {
        GenericReport.channels(of)
    }

    fn figures(&self, of: &SimulationView<'_>) -> Vec<Figure> {
        GenericReport.figures(of)
    }

    fn sections(&self, whose: &str, of: Option<&SimulationView<'_>>) -> Vec<Section> {
        GenericReport.sections(whose, of)
    }

    fn zero(&self) -> &'static str {
        GenericReport.zero()
    }

    fn group(&self, unknown: &Unknown) -> &'static str {
        GenericReport.group(unknown)
    }

    fn tables(&self, run: &SingleRun) -> Vec<Table> {
        GenericReport.tables(run)
    }

    fn files(
        &self,
        folder: &Path,
        runs: &[(&str, SimulationView<'_>)],
    ) -> Result<Vec<PathBuf>, ReportError> {
        let mut written = GenericReport.files(folder, runs)?;
        let objective =
            |shown: &SimulationView<'_>| shown.condition == shown.case.objective.condition;
        let best = runs.iter().rev().find(|(_, shown)| objective(shown));
        if let Some((_, shown)) = best {
            let text = pest::rei(&residuals(shown));
            written.push(stream(folder, "residuals.rei", |mut file| {
                Ok(file.write_all(text.as_bytes())?)
            })?);
        }
        Ok(written)
    }

    fn frequency_hz(&self, case: &Case, condition: usize) -> Option<f64> {
        GenericReport.frequency_hz(case, condition)
    }
}

/// Pairs every measured value of a condition with the simulated one, for PEST's residual file.
fn residuals(shown: &SimulationView<'_>) -> Vec<ReiRow> {
    let external = External::of(&shown.case.model).ok();
    let measured = shown.case.measured(shown.condition);
    let rows = measured.flat_map(|(at, channel, record)| {
        let names = external
            .as_ref()
            .and_then(|external| match external.curves.get(at)? {
                ChannelSource::Named(names) => Some(names.clone()),
                ChannelSource::Column { .. } | ChannelSource::Pointer { .. } => None,
            });
        let modelled = shown.channel(channel);
        // an imported channel has the name of its group as title, if that is no name of a channel
        let is_word = !channel.title.contains(char::is_whitespace);
        let group = if is_word {
            &channel.title
        } else {
            &channel.name
        };
        let pairs = record.mean.iter().zip(modelled).enumerate();
        let row = move |(i, (measured, modelled)): (usize, (&f64, &f64))| ReiRow {
            name: names
                .as_ref()
                .and_then(|names| names.get(i).cloned())
                .unwrap_or_else(|| format!("{}_{}", channel.name, i + 1)),
            group: group.clone(),
            measured: *measured,
            modelled: *modelled,
            weight: channel.weights.get(i).copied().unwrap_or(1.0),
        };
        pairs.map(row).collect::<Vec<_>>()
    });
    rows.collect()
}
