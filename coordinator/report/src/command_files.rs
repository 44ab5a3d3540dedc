//! Report of models that are external commands: the general report, with PEST's residual file of the
//! calibration for programs that read it.
use crate::{
    data::SimulationView,
    folder::{ReportError, stream},
    model_report::{ModelReport, curves_file},
};
use case::kind::CommandModel;
use exchange::pest::{self, ReiRow};
use protocol::external::{ChannelSource, External};
use std::{
    io::Write as _,
    path::{Path, PathBuf},
};

impl ModelReport for CommandModel {
    fn files(
        &self,
        folder: &Path,
        runs: &[(&str, SimulationView<'_>)],
    ) -> Result<Vec<PathBuf>, ReportError> {
        let mut written = vec![curves_file(folder, runs)?];
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
