//! Conditions: their names, and what travels of them as it is.
use super::{
    super::{document::Document, error::CaseError, names},
    file::{ConditionEntry, ModelEntry},
};
use protocol::case::{Condition, ModelSettings};
use serde::Serialize;
use toml::Table;

/// What a model alone understands of a case, as text in TOML.
#[derive(Serialize)]
struct Own<'a> {
    /// `[model]` without its kind.
    model: &'a Table,
    /// `[[conditions]]` without their names.
    conditions: Vec<&'a Table>,
}

/// Names of the conditions.
///
/// # Errors
/// None, two of one name, one that cannot be typed.
pub(super) fn read(
    document: &Document,
    entries: &[ConditionEntry],
) -> Result<Vec<Condition>, CaseError> {
    let all: Vec<&str> = entries.iter().map(|entry| entry.name.as_str()).collect();
    names::check(document, "conditions", "condition", &all)?;
    let named = |name: &&str| Condition {
        name: (*name).to_owned(),
    };
    Ok(all.iter().map(named).collect())
}

/// The model's own part, as it travels.
pub(super) fn settings(model: &ModelEntry, conditions: &[ConditionEntry]) -> ModelSettings {
    let own = Own {
        model: &model.own,
        conditions: conditions.iter().map(|entry| &entry.own).collect(),
    };
    // what was read as TOML can be written as TOML
    let text = toml::to_string(&own).unwrap_or_default();
    ModelSettings::exact(model.kind.clone(), text.into_bytes())
}
