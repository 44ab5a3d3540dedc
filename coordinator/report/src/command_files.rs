//! Report of models that are external commands: the general report, with PEST's residual file of the
//! calibration for programs that read it.
use crate::{
    Drawing, Figure, General, ReportError, Section, Shown, SingleRun, Table, folder::stream,
};
use exchange::pest::{self, ReiRow};
use protocol::{
    case::{Case, Unknown},
    external::{External, Source},
};
use std::{
    io::Write as _,
    path::{Path, PathBuf},
};

/// Drawing of the general report with PEST's files added.
pub(crate) struct Files;

impl Drawing for Files {
    fn channels(&self, of: &Shown<'_>) -> Vec<Figure> {
        General.channels(of)
    }

    fn figures(&self, of: &Shown<'_>) -> Vec<Figure> {
        General.figures(of)
    }

    fn sections(&self, whose: &str, of: Option<&Shown<'_>>) -> Vec<Section> {
        General.sections(whose, of)
    }

    fn zero(&self) -> &'static str {
        General.zero()
    }

    fn group(&self, unknown: &Unknown) -> &'static str {
        General.group(unknown)
    }

    fn tables(&self, run: &SingleRun) -> Vec<Table> {
        General.tables(run)
    }

    fn files(
        &self,
        folder: &Path,
        runs: &[(&str, Shown<'_>)],
    ) -> Result<Vec<PathBuf>, ReportError> {
        let mut written = General.files(folder, runs)?;
        let objective = |shown: &Shown<'_>| shown.condition == shown.case.objective.condition;
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
        General.frequency_hz(case, condition)
    }
}

/// Returns every measured value of a condition with the simulated one.
fn residuals(shown: &Shown<'_>) -> Vec<ReiRow> {
    let external = External::of(&shown.case.model).ok();
    let measured = shown.case.measured(shown.condition);
    let rows = measured.flat_map(|(at, channel, record)| {
        let names = external
            .as_ref()
            .and_then(|external| match external.curves.get(at)? {
                Source::Named(names) => Some(names.clone()),
                Source::Column { .. } | Source::Pointer { .. } => None,
            });
        let modelled = shown.channel(channel);
        let pairs = record.mean.iter().zip(modelled).enumerate();
        let row = move |(i, (measured, modelled)): (usize, (&f64, &f64))| ReiRow {
            name: names
                .as_ref()
                .and_then(|names| names.get(i).cloned())
                .unwrap_or_else(|| format!("{}_{}", channel.name, i + 1)),
            group: channel.name.clone(),
            measured: *measured,
            modelled: *modelled,
            weight: channel.weights.get(i).copied().unwrap_or(1.0),
        };
        pairs.map(row).collect::<Vec<_>>()
    });
    rows.collect()
}
