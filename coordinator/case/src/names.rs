//! Checks on the names in a list of tables: allowed characters and uniqueness.
use super::{
    document::{Document, DocumentStep},
    error::CaseError,
};

/// Checks the names of the case file's tables under the key `list`; `what` is the word for one of these
/// tables in messages.
///
/// # Errors
/// Returns an error for the first name that is empty, duplicate or has characters not allowed on command
/// lines and in file names, or if the list is empty.
pub fn check(document: &Document, list: &str, what: &str, names: &[&str]) -> Result<(), CaseError> {
    if names.is_empty() {
        return Err(document.field(
            &[DocumentStep::Key(list)],
            "[]",
            format!("at least one {what}"),
            &format!("add a [[{list}]] table"),
        ));
    }
    for (index, name) in names.iter().enumerate() {
        let way = [
            DocumentStep::Key(list),
            DocumentStep::Index(index),
            DocumentStep::Key("name"),
        ];
        check_one(document, &way, what, name, names[..index].contains(name))?;
    }
    Ok(())
}

/// Checks the name of one table of a case file; `is_there` says whether an earlier table has the same name.
///
/// # Errors
/// As [`check`].
pub fn check_one(
    document: &Document,
    way: &[DocumentStep<'_>],
    what: &str,
    name: &str,
    is_there: bool,
) -> Result<(), CaseError> {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    let quoted = format!("\"{name}\"");
    if name.is_empty() || !name.chars().all(plain) {
        return Err(document.field(
            way,
            quoted,
            "a short name of letters, digits, `-`, `_` and `.`",
            "the name is typed on command lines and becomes part of file names, as `5rpm`",
        ));
    }
    if is_there {
        return Err(document.field(
            way,
            quoted,
            format!("a name that no other {what} has"),
            &format!("duplicate {what}: rename or remove one of the two"),
        ));
    }
    Ok(())
}
