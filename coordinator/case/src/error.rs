//! What can be wrong with a case: one error, one place, one remedy.
//!
//! Every message names the file, then the field (or row and column), its value and what is allowed,
//! and ends in a `help:` line that says what to do. It does not know who reads it: the command
//! line prints it as it is.
use std::{fmt, io, path::Path};
use thiserror::Error;

/// Why a case cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CaseError {
    /// A file that is needed is not there.
    #[error("{}: no such file; it is {role}\nhelp: {help}", path.display())]
    Missing {
        /// The file.
        path: Box<Path>,
        /// What it is needed for and who names it.
        role: Box<str>,
        /// What to do.
        help: Box<str>,
    },
    /// A file cannot be read.
    #[error("{}: cannot be read: {source}\nhelp: check that it is a file and that you may read it", path.display())]
    Unreadable {
        /// The file.
        path: Box<Path>,
        /// What the system says.
        source: io::Error,
    },
    /// A file cannot be replaced.
    #[error("{}: cannot be written: {source}\nhelp: check that there is room and that you may write there; the old file is unchanged", path.display())]
    Unwritable {
        /// The file.
        path: Box<Path>,
        /// What the system says.
        source: io::Error,
    },
    /// A file as a whole is not what it should be: empty, truncated, of another format.
    #[error("{}: {problem}\nhelp: {help}", path.display())]
    Damaged {
        /// The file.
        path: Box<Path>,
        /// What is wrong with it.
        problem: Box<str>,
        /// What to do.
        help: Box<str>,
    },
    /// A TOML file is malformed: syntax, an unknown or missing key, a value of another type.
    #[error("{}: {problem}{excerpt}\nhelp: {help}", path.display())]
    Toml {
        /// The file.
        path: Box<Path>,
        /// What is wrong.
        problem: Box<str>,
        /// The source line with a marker below it; empty where there is none.
        excerpt: Box<str>,
        /// What to do.
        help: Box<str>,
    },
    /// A field has a value that is not allowed.
    #[error("{}: `{field}` = {value} is not allowed{excerpt}\nallowed: {allowed}\nhelp: {help}", path.display())]
    Field {
        /// The file.
        path: Box<Path>,
        /// The field, with the tables it stands in.
        field: Box<str>,
        /// Its value.
        value: Box<str>,
        /// The allowed values, with the unit.
        allowed: Box<str>,
        /// The source line with a marker below it; empty where there is none.
        excerpt: Box<str>,
        /// What to do.
        help: Box<str>,
    },
    /// A table lacks a column.
    #[error("{}: column `{column}` is missing; the columns are: {found}\nhelp: {help}", path.display())]
    Column {
        /// The file.
        path: Box<Path>,
        /// The column.
        column: Box<str>,
        /// The columns there are.
        found: Box<str>,
        /// What to do.
        help: Box<str>,
    },
    /// A cell, or a whole row, of a table has a value that is not allowed.
    #[error("{}: row {row}, column `{column}`: {value} is not allowed\nallowed: {allowed}\nhelp: {help}", path.display())]
    Cell {
        /// The file.
        path: Box<Path>,
        /// Line of the file; the header is row 1.
        row: u64,
        /// The column.
        column: Box<str>,
        /// What stands there.
        value: Box<str>,
        /// The allowed values, with the unit.
        allowed: Box<str>,
        /// What to do.
        help: Box<str>,
    },
    /// Several faults that do not depend on each other; two at least.
    #[error("{0}")]
    Several(Several),
    /// Two statements of a case exclude each other.
    #[error("{}: {field} is {value}, but {other}\nhelp: {help}", path.display())]
    Contradiction {
        /// The file of the first statement.
        path: Box<Path>,
        /// What is stated.
        field: Box<str>,
        /// Its value.
        value: Box<str>,
        /// The other statement, with its place.
        other: Box<str>,
        /// What to do.
        help: Box<str>,
    },
}

/// Faults of one case; shown one after the other.
#[derive(Debug)]
pub struct Several(Vec<CaseError>);

impl fmt::Display for Several {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "{} faults", self.0.len())?;
        for (index, fault) in self.0.iter().enumerate() {
            write!(to, "\n\n{}. {fault}", index + 1)?;
        }
        Ok(())
    }
}

/// Collects faults that do not depend on each other, so that all of them are said at once.
#[derive(Debug, Default)]
pub struct Faults(Vec<CaseError>);

impl Faults {
    /// Takes a result apart: the value, or none after its fault was kept.
    pub fn take<T>(&mut self, result: Result<T, CaseError>) -> Option<T> {
        result.map_err(|fault| self.add(fault)).ok()
    }

    /// Keeps a fault; one that is several, as those.
    pub fn add(&mut self, fault: CaseError) {
        if let CaseError::Several(Several(faults)) = fault {
            self.0.extend(faults);
        } else {
            self.0.push(fault);
        }
    }

    /// Ends the collection.
    ///
    /// # Errors
    /// If any fault was kept: itself, or all of them as [`CaseError::Several`].
    pub fn end(mut self) -> Result<(), CaseError> {
        match self.0.len() {
            0 => Ok(()),
            1 => self.0.pop().map_or(Ok(()), Err),
            _ => Err(CaseError::Several(Several(self.0))),
        }
    }
}

/// A problem of a whole file.
pub fn damaged(path: &Path, problem: impl Into<String>, help: &str) -> CaseError {
    CaseError::Damaged {
        path: path.into(),
        problem: problem.into().into(),
        help: help.into(),
    }
}

/// Two statements that exclude each other.
pub fn contradiction(
    path: &Path,
    field: impl Into<String>,
    value: impl Into<String>,
    other: impl Into<String>,
    help: &str,
) -> CaseError {
    CaseError::Contradiction {
        path: path.into(),
        field: field.into().into(),
        value: value.into().into(),
        other: other.into().into(),
        help: help.into(),
    }
}
