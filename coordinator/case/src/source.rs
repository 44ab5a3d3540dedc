//! Location of a case file and of the measured files that replace its own, and the kind of model that it states.
use super::{
    document::{Document, DocumentStep},
    error::{CaseError, damaged},
};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Parts of a case that the command line replaces.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// Folder whose files replace the measured files of the same names in the case.
    pub measured: Option<PathBuf>,
}

/// Case file, its folder, and the folder of replacement records.
#[derive(Clone, Copy, Debug)]
pub struct RecordFolder<'a> {
    /// Folder of the case, to which the file names in the case are relative.
    pub folder: &'a Path,
    /// Folder whose files replace the records of the same names.
    pub measured: Option<&'a Path>,
    /// Parsed case file.
    pub document: &'a Document,
}

impl<'a> RecordFolder<'a> {
    /// Creates the location of a case from its file, its folder and the overrides of the command line.
    pub fn new(folder: &'a Path, overrides: &'a Overrides, document: &'a Document) -> Self {
        Self {
            folder,
            measured: overrides.measured.as_deref(),
            document,
        }
    }
}

/// Reads the case file.
///
/// # Errors
/// A case file that cannot be read, or a missing folder of replacement records.
pub fn document(folder: &Path, overrides: &Overrides) -> Result<Document, CaseError> {
    let measured = overrides.measured.as_deref();
    if let Some(absent) = measured.filter(|path| !path.is_dir()) {
        return Err(damaged(
            absent,
            "the folder given by --measured does not exist",
            "give the folder that holds the records of the test",
        ));
    }
    Document::read(
        &folder.join("case.toml"),
        "the description of the case; `horsehead case new` writes a template",
    )
}

/// Part of a case file that cases of every kind contain.
#[derive(Debug, Deserialize)]
struct AnyCase {
    model: Option<AnyModel>,
}

/// Table `[model]`, of which only `kind` is read.
#[derive(Debug, Deserialize)]
struct AnyModel {
    kind: Option<String>,
}

/// Returns the kind of model that a case file states.
///
/// # Errors
/// Returns an error if no kind is stated; a guess could misinterpret the case.
pub(crate) fn stated_kind(document: &Document) -> Result<String, CaseError> {
    let kind = document
        .parse::<AnyCase>()?
        .model
        .and_then(|model| model.kind);
    kind.filter(|kind| !kind.is_empty()).ok_or_else(|| {
        document.field(
            &[DocumentStep::Key("model"), DocumentStep::Key("kind")],
            "absent",
            "the name of a kind of model, which workers announce",
            "add a table [model] with kind; that of a pumping unit is kind = \"dhh\"",
        )
    })
}
