//! Checks on the names in a list of tables: allowed characters and uniqueness.
use super::{
    document::{Document, DocumentStep},
    error::CaseError,
};
use std::collections::BTreeSet;

/// Checks the names of the case file's tables under the key `list`, which are typed on command lines and become part of file
/// names; `what` is the word for one of these tables in messages.
///
/// # Errors
/// Returns an error for the first name that is empty, duplicate or has characters not allowed on command
/// lines and in file names, or if the list is empty.
pub fn check(document: &Document, list: &str, what: &str, names: &[&str]) -> Result<(), CaseError> {
    check_list(document, (list, what), names, |keys, name, is_there| {
        check_one(document, keys, what, name, is_there)
    })
}

/// Checks names as [`check`] does, but allows all that other programs write: any printable characters of ASCII except
/// blanks, commas, quotes, braces, `=`, `#` and `\`, as `pname:k_inst:0_x:1.5` and `density[0]`.
///
/// # Errors
/// As [`check`].
pub fn check_program_names(
    document: &Document,
    list: &str,
    what: &str,
    names: &[&str],
) -> Result<(), CaseError> {
    let plain = |c: char| c.is_ascii_graphic() && !",\"'`{}=#\\".contains(c);
    check_list(document, (list, what), names, |keys, name, is_there| {
        // the key under which gene files state effects
        let is_allowed = name != "effects" && name.chars().all(plain);
        let words = (
            "a name other than `effects`, without blanks, commas, quotes, braces, `=`, `#` and `\\`",
            "the name is a key of gene files and is typed on command lines, as `stiffness`",
        );
        check_name(document, keys, what, (name, is_allowed, is_there), words)
    })
}

fn check_list(
    document: &Document,
    (list, what): (&str, &str),
    names: &[&str],
    check: impl Fn(&[DocumentStep<'_>], &str, bool) -> Result<(), CaseError>,
) -> Result<(), CaseError> {
    if names.is_empty() {
        return Err(document.field(
            &[DocumentStep::Key(list)],
            "[]",
            format!("at least one {what}"),
            &format!("add a [[{list}]] table"),
        ));
    }
    let mut seen = BTreeSet::new();
    for (index, name) in names.iter().enumerate() {
        let keys = [
            DocumentStep::Key(list),
            DocumentStep::Index(index),
            DocumentStep::Key("name"),
        ];
        check(&keys, name, !seen.insert(*name))?;
    }
    Ok(())
}

/// Checks the name of one table of a case file; `is_there` says whether an earlier table has the same name.
///
/// # Errors
/// As [`check`].
pub fn check_one(
    document: &Document,
    keys: &[DocumentStep<'_>],
    what: &str,
    name: &str,
    is_there: bool,
) -> Result<(), CaseError> {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    let is_allowed = name.chars().all(plain);
    let words = (
        "a short name of letters, digits, `-`, `_` and `.`",
        "the name is typed on command lines and becomes part of file names, as `5rpm`",
    );
    check_name(document, keys, what, (name, is_allowed, is_there), words)
}

/// Checks that a name is not empty, has only allowed characters and is that of no earlier table; `allowed` and `help` are the
/// words about its characters.
fn check_name(
    document: &Document,
    keys: &[DocumentStep<'_>],
    what: &str,
    (name, is_allowed, is_there): (&str, bool, bool),
    (allowed, help): (&str, &str),
) -> Result<(), CaseError> {
    let quoted = format!("\"{name}\"");
    if name.is_empty() || !is_allowed {
        return Err(document.field(keys, quoted, allowed, help));
    }
    if is_there {
        return Err(document.field(
            keys,
            quoted,
            format!("a name that no other {what} has"),
            &format!("duplicate {what}: rename or remove one of the two"),
        ));
    }
    Ok(())
}
