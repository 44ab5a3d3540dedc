//! Where a case is read from.
use super::{
    document::Document,
    error::{CaseError, damaged},
};
use std::path::{Path, PathBuf};

/// What a command line may replace in a case.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// Folder whose files, of the same names, replace what was measured of the case.
    pub measured: Option<PathBuf>,
}

/// A case file with its folder.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// The folder: files that the case names are beside it.
    pub folder: &'a Path,
    /// Folder whose files, of the same names, replace those of the records.
    pub measured: Option<&'a Path>,
    /// The case file.
    pub document: &'a Document,
}

impl<'a> Source<'a> {
    /// A case file, its folder, and what replaces a part of it.
    pub fn new(folder: &'a Path, overrides: &'a Overrides, document: &'a Document) -> Self {
        Self {
            folder,
            measured: overrides.measured.as_deref(),
            document,
        }
    }
}

/// The case file.
///
/// # Errors
/// If it cannot be read, or the folder that replaces its records is not there.
pub fn document(folder: &Path, overrides: &Overrides) -> Result<Document, CaseError> {
    let measured = overrides.measured.as_deref();
    if let Some(absent) = measured.filter(|path| !path.is_dir()) {
        return Err(damaged(
            absent,
            "there is no such folder; --measured names it",
            "give the folder that holds the records of the test",
        ));
    }
    Document::read(
        &folder.join("case.toml"),
        "the description of the case; `horsehead case new` writes a template",
    )
}
