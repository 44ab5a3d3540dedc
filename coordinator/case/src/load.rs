//! Loading of a case folder as a [`Case`], by the reader of the model kind that `case.toml` names.
use super::{
    error::CaseError,
    kind::KnownKind,
    loaded::Loaded,
    source::{Overrides, RecordFolder, document, stated_kind},
    summary::CaseSummary,
};
use protocol::case::Case;
use std::path::Path;

/// Loads a case folder.
///
/// # Errors
/// Returns the first fault found; see [`CaseError`].
pub fn load(folder: &Path, overrides: &Overrides) -> Result<Case, CaseError> {
    load_with_notes(folder, overrides).map(|loaded| loaded.case)
}

/// Loads a case folder, with its notes, separate cycles and effects.
///
/// # Errors
/// As [`load`].
pub fn load_with_notes(folder: &Path, overrides: &Overrides) -> Result<Loaded, CaseError> {
    let document = document(folder, overrides)?;
    KnownKind::named(&stated_kind(&document)?)
        .form()
        .read(&RecordFolder::new(folder, overrides, &document))
}

/// Loads a case folder and summarises its contents, for `horsehead case check`.
///
/// # Errors
/// As [`load`].
pub fn check(folder: &Path, overrides: &Overrides) -> Result<CaseSummary, CaseError> {
    let document = document(folder, overrides)?;
    KnownKind::named(&stated_kind(&document)?)
        .form()
        .check(&RecordFolder::new(folder, overrides, &document))
}
