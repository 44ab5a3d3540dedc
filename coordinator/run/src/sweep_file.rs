//! Sweep over the content of a file, a grid of settings or a table of individuals: its settings, and its result as the
//! journal states it.
use crate::{command_line::quote_path, manifest::RunIdentity, opened::Run, searches::Searches};
use report::{Report, sweep};
use search::space::Space;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use study::{
    RecordedTable,
    orthogonal::{Factor, TrialRun},
};

/// File that a sweep works through, with its content.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweptFile {
    /// Path of the file.
    pub file: PathBuf,
    /// What the file holds.
    pub holds: FileContent,
}

/// Content of a swept file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FileContent {
    /// Full factorial grid: searches with every combination of factor levels.
    Grid(Searches),
    /// Table of individuals, identified by the hash of their values.
    Individuals(String),
}

impl SweptFile {
    /// Returns the factors of a grid; none for a table.
    pub fn factors(&self) -> &[Factor] {
        match &self.holds {
            FileContent::Grid(searches) => &searches.factors,
            FileContent::Individuals(_) => &[],
        }
    }
}

impl RunIdentity for SweptFile {
    const KIND: &'static str = "sweep";
    const SEEDED: bool = false;

    fn command(&self, case: &str) -> String {
        format!("{} {} --case {case}", Self::KIND, quote_path(&self.file))
    }

    fn difference(&self, earlier: &Self) -> String {
        if self.holds == earlier.holds {
            format!("it is a sweep of {}", earlier.file.display())
        } else {
            "its file holds something else".to_owned()
        }
    }
}

/// Returns every combination of level indices, given the number of levels of each factor; the last factor
/// varies fastest.
pub fn combinations(levels: &[usize]) -> Vec<Vec<usize>> {
    let one = |rows: Vec<Vec<usize>>, count: &usize| {
        let longer = rows.iter().flat_map(|row| {
            (0..*count).map(move |level| row.iter().copied().chain([level]).collect())
        });
        longer.collect()
    };
    levels.iter().fold(vec![Vec::new()], one)
}

/// Result of a finished sweep of a file.
#[derive(Debug)]
pub enum SweepResult {
    /// Searches of a grid, one for each combination of levels and seed.
    Grid(Vec<TrialRun>),
    /// Individuals of a table with their scores.
    Individuals(RecordedTable),
}

/// Reads the result of a finished sweep of a file from its journal.
///
/// # Errors
/// If the sweep is not finished, or its journal cannot be read.
pub fn recorded(run: &Run<SweptFile>) -> anyhow::Result<SweepResult> {
    let path = run.expect_journal()?;
    let read = match run.manifest.settings.holds {
        FileContent::Grid(_) => study::read_grid(&path).map(SweepResult::Grid),
        FileContent::Individuals(_) => {
            let space = Space::new(&run.case.unknowns)?;
            study::read_table(&path, |row| space.expand(row)).map(SweepResult::Individuals)
        }
    };
    read.map_err(|error| run.unreadable(error))
}

/// Builds the report of a finished sweep of a file.
///
/// # Errors
/// If the case cannot be encoded.
pub fn report(run: &Run<SweptFile>, result: &SweepResult) -> anyhow::Result<Report> {
    let (case, origin) = (&run.case, run.origin(String::new())?);
    Ok(match result {
        SweepResult::Grid(tried) => {
            sweep::grid(case, &origin, run.manifest.settings.factors(), tried)
        }
        SweepResult::Individuals(RecordedTable {
            names,
            rows,
            scores,
        }) => sweep::individuals(case, &origin, (names, rows, scores)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_combination_comes_once_in_order() {
        let all = [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2]];
        assert_eq!(combinations(&[2, 3]), all);
    }
}
