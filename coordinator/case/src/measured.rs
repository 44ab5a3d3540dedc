//! Check that a condition has a measured record.
use super::error::CaseError;
use protocol::case::Case;
use std::path::Path;

/// Checks that a condition has a measured record, which calibration, diagnosis and comparison need.
///
/// # Errors
/// Returns an error with the case file, the condition and the remedy.
pub fn require_record(folder: &Path, case: &Case, condition: usize) -> Result<(), CaseError> {
    if case.is_measured(condition) {
        return Ok(());
    }
    let found = case.conditions.get(condition);
    let name = found.map_or("?", |condition| condition.name.as_str());
    let (field, remedy) = crate::kind::of(case).missing_record(condition, name);
    Err(CaseError::Field {
        path: folder.join("case.toml").into(),
        field: field.into(),
        value: "absent".into(),
        excerpt: "".into(),
        allowed: format!("a record of condition `{name}`: there is nothing to compare with").into(),
        help: format!(
            "{remedy}, or give --measured DIR; `horsehead simulate` and `horsehead case check` need no \
             record"
        )
        .into(),
    })
}
