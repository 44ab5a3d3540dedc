//! Errors of a case, each with one location and one remedy.
//!
//! Every message names the file, then the field (or row and column), its value and what is allowed, and ends
//! in a `help:` line with the remedy. The command line prints messages unchanged.
use std::{fmt, io, path::Path};
use thiserror::Error;

/// Reason why a case cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CaseError {
    /// Required file that does not exist.
    #[error("{}: no such file; it is {role}\nhelp: {help}", path.display())]
    Missing {
        /// Path of the missing file.
        path: Box<Path>,
        /// Purpose of the missing file, and where the case names it.
        role: Box<str>,
        /// Remedy that is suggested for the missing file.
        help: Box<str>,
    },
    /// File that cannot be read.
    #[error("{}: cannot be read: {source}\nhelp: check that it is a file and that you may read it", path.display())]
    Unreadable {
        /// Path of the unreadable file.
        path: Box<Path>,
        /// Error of the operating system.
        source: io::Error,
    },
    /// File that cannot be replaced.
    #[error("{}: cannot be written: {source}\nhelp: check that there is room and that you may write there; the old file is unchanged", path.display())]
    Unwritable {
        /// Path of the file that cannot be replaced.
        path: Box<Path>,
        /// Error of the operating system.
        source: io::Error,
    },
    /// File that is unusable as a whole: empty, truncated or in another format.
    #[error("{}: {problem}\nhelp: {help}", path.display())]
    Damaged {
        /// Path of the damaged file.
        path: Box<Path>,
        /// Description of what is wrong with the damaged file.
        problem: Box<str>,
        /// Remedy that is suggested for the damaged file.
        help: Box<str>,
    },
    /// Malformed TOML file: invalid syntax, an unknown or missing key, or a value of another type.
    #[error("{}: {problem}{excerpt}\nhelp: {help}", path.display())]
    Toml {
        /// Path of the TOML file.
        path: Box<Path>,
        /// Description of what is wrong with the TOML file.
        problem: Box<str>,
        /// Source line of the TOML error with a marker below it; empty if not available.
        excerpt: Box<str>,
        /// Remedy that is suggested for the TOML error.
        help: Box<str>,
    },
    /// Field with a value that is not allowed.
    #[error("{}: `{field}` = {value} is not allowed{excerpt}\nallowed: {allowed}\nhelp: {help}", path.display())]
    Field {
        /// Path of the file with the field.
        path: Box<Path>,
        /// Dotted path of the field within the file.
        field: Box<str>,
        /// Value that the field has, which is not allowed.
        value: Box<str>,
        /// Allowed values of the field, with their unit.
        allowed: Box<str>,
        /// Source line of the field with a marker below it; empty if not available.
        excerpt: Box<str>,
        /// Remedy that is suggested for the field.
        help: Box<str>,
    },
    /// Table without a required column.
    #[error("{}: column `{column}` is missing; the columns are: {found}\nhelp: {help}", path.display())]
    Column {
        /// Path of the table's file.
        path: Box<Path>,
        /// Name of the missing column.
        column: Box<str>,
        /// Names of the columns that the table has.
        found: Box<str>,
        /// Remedy that is suggested for the missing column.
        help: Box<str>,
    },
    /// Table cell, or whole row, with a value that is not allowed.
    #[error("{}: row {row}, column `{column}`: {value} is not allowed\nallowed: {allowed}\nhelp: {help}", path.display())]
    Cell {
        /// Path of the table's file.
        path: Box<Path>,
        /// Row number of the faulty cell; the header is row 1.
        row: u64,
        /// Name of the faulty cell's column.
        column: Box<str>,
        /// Content of the faulty cell.
        value: Box<str>,
        /// Values that the table cell may have, with their unit.
        allowed: Box<str>,
        /// Remedy that is suggested for the faulty cell.
        help: Box<str>,
    },
    /// Two or more independent errors of one case.
    #[error("{0}")]
    Several(Several),
    /// Two statements of a case that contradict each other.
    #[error("{}: {field} is {value}, but {other}\nhelp: {help}", path.display())]
    Contradiction {
        /// Path of the file with the first of two contradictory statements.
        path: Box<Path>,
        /// Field of the case with the first of two contradictory statements.
        field: Box<str>,
        /// Value that the first of two contradictory statements gives.
        value: Box<str>,
        /// Text of the second, contradicting statement, with its location.
        other: Box<str>,
        /// Remedy that is suggested for the contradiction.
        help: Box<str>,
    },
}

/// Independent errors of one case, displayed as a numbered list.
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

/// Collector of independent errors, so that all of them are reported at once.
#[derive(Debug, Default)]
pub struct Faults(Vec<CaseError>);

impl Faults {
    /// Returns the value of a result; stores its error and returns `None` if it failed.
    pub fn take<T>(&mut self, result: Result<T, CaseError>) -> Option<T> {
        result.map_err(|fault| self.add(fault)).ok()
    }

    /// Adds an error; [`CaseError::Several`] is split into its errors.
    pub fn add(&mut self, fault: CaseError) {
        if let CaseError::Several(Several(faults)) = fault {
            self.0.extend(faults);
        } else {
            self.0.push(fault);
        }
    }

    /// Returns the collected errors as a result, once all checks are done.
    ///
    /// # Errors
    /// Returns the collected error, or all of them as [`CaseError::Several`] if there are several.
    pub fn end(mut self) -> Result<(), CaseError> {
        match self.0.len() {
            0 => Ok(()),
            1 => self.0.pop().map_or(Ok(()), Err),
            _ => Err(CaseError::Several(Several(self.0))),
        }
    }
}

/// Builds the error for a file that is unusable as a whole.
pub fn damaged(path: &Path, problem: impl Into<String>, help: &str) -> CaseError {
    CaseError::Damaged {
        path: path.into(),
        problem: problem.into().into(),
        help: help.into(),
    }
}

/// Builds the error for two contradictory statements.
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
