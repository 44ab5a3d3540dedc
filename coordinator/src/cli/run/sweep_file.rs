//! Settings of a sweep over the content of a file: a grid of settings, or a table of individuals.
use super::{command_line::quote_path, manifest::RunIdentity, searches::Searches};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// File that a sweep works through, with its content.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SweptFile {
    pub(crate) file: PathBuf,
    pub(crate) holds: FileContent,
}

/// Content of a swept file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum FileContent {
    /// Full factorial grid: searches with every combination of factor levels.
    Grid(Searches),
    /// Table of individuals, identified by the hash of their values.
    Individuals(String),
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
pub(crate) fn combinations(levels: &[usize]) -> Vec<Vec<usize>> {
    let one = |rows: Vec<Vec<usize>>, count: &usize| {
        let longer = rows.iter().flat_map(|row| {
            (0..*count).map(move |level| row.iter().copied().chain([level]).collect())
        });
        longer.collect()
    };
    levels.iter().fold(vec![Vec::new()], one)
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
