//! Names and units of a table's columns.
use super::{
    layout::{Cells, Layout},
    lines::Lines,
    unit,
};
use crate::{
    document::nearest,
    error::{CaseError, damaged},
};
use exchange::utf8_or_latin1;
use serde::{Deserialize, Serialize};
use std::{collections::HashMap, path::Path};

/// Largest number of columns.
const MOST: usize = 1000;

/// Column of a table and the unit of its numbers.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Quantity {
    /// Name of the column in the header; `NAME#2` is the second one of the name, `#3` the third column.
    pub(crate) column: String,
    /// Unit of the numbers.
    pub(crate) unit: String,
}

/// Names and units of the columns of a table, from left to right.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Columns {
    /// Names as in the header, made unique: the second column of a name is `NAME#2`; a column without a name
    /// is `#3` by its place.
    pub(crate) names: Vec<String>,
    /// Units by the line of units or the names; `None` where neither states a known one.
    pub(crate) units: Vec<Option<String>>,
    /// Number of cells of the first row of data.
    pub(super) usual: usize,
    /// Line of the names.
    pub(super) header: Vec<u8>,
}

impl Columns {
    /// Reads the names and units from the lines that a layout states.
    ///
    /// # Errors
    /// Returns an error for a file that cannot be read or has fewer lines.
    pub(crate) fn read(path: &Path, layout: &Layout) -> Result<Self, CaseError> {
        let (mut header, mut units) = (Cells::default(), Cells::default());
        let mut first = Cells::default();
        let mut names = Vec::new();
        let mut lines = Lines::open(path)?;
        loop {
            let Some((number, line)) = lines.next()? else {
                return Err(damaged(
                    path,
                    format!(
                        "the file ends before line {}, the first of the data by `table.first_line`",
                        layout.first_line
                    ),
                    "copy the file again, or correct `table` in the mapping",
                ));
            };
            if layout.header_line == Some(number) {
                line.clone_into(&mut names);
                let line = line.trim_ascii_start();
                let bare = line.strip_prefix(b"#").unwrap_or(line);
                layout.delimiter.split(bare, &mut header);
            } else if layout.units_line == Some(number) {
                layout.delimiter.split(line, &mut units);
            } else if number >= layout.first_line {
                layout.delimiter.split(line, &mut first);
                break;
            }
        }
        let width = header.filled().max(first.filled());
        if width > MOST {
            return Err(damaged(
                path,
                format!(
                    "line {} has {width} cells; at most {MOST} are read",
                    layout.first_line
                ),
                "export one line per sample, with the channels side by side",
            ));
        }
        if layout.header_line.is_some() && header.filled() < first.filled() {
            return Err(damaged(
                path,
                format!(
                    "the header has {} cells, the first row of data {}",
                    header.filled(),
                    first.filled()
                ),
                "name every column, in a copy of the file: without that no column is known by its name",
            ));
        }
        let mut columns = Self {
            usual: first.len(),
            header: names,
            ..Self::default()
        };
        let mut counts: HashMap<String, usize> = HashMap::new();
        for place in 0..width {
            let cell =
                |cells: &Cells| utf8_or_latin1(cells.get(place).unwrap_or_default()).into_owned();
            let name = cell(&header);
            let count = counts.entry(name.clone()).or_default();
            *count += 1;
            columns.names.push(match (name.as_str(), *count) {
                ("", _) => format!("#{}", place + 1),
                (_, 1) => name.clone(),
                (_, count) => format!("{name}#{count}"),
            });
            // a name and a line of units that contradict each other state nothing
            columns
                .units
                .push(match (unit::normal(&cell(&units)), unit::stated(&name)) {
                    (Some(unit), Some(other)) => Some(unit).filter(|unit| *unit == other),
                    (unit, other) => unit.or(other),
                });
        }
        Ok(columns)
    }

    /// Returns the place of a column by its name.
    ///
    /// # Errors
    /// Returns an error that lists the columns if there is none of the name.
    pub(crate) fn place(&self, path: &Path, name: &str) -> Result<usize, CaseError> {
        let found = self.names.iter().position(|own| own == name);
        found.ok_or_else(|| {
            let near = nearest(name, self.names.iter().map(String::as_str));
            CaseError::Column {
                path: path.into(),
                column: name.into(),
                found: crate::table::clip(&self.names.join(", "), 400).into(),
                help: near
                    .map_or_else(
                        || "name one of these columns in the mapping".to_owned(),
                        |near| format!("did you mean `{near}`? correct the mapping"),
                    )
                    .into(),
            }
        })
    }
}
