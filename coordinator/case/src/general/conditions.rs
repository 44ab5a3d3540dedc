//! Reading of the conditions: their names, and the settings passed on to the model unchanged.
use super::{
    super::{document::Document, error::CaseError, names},
    file::{ConditionEntry, ModelEntry},
};
use protocol::case::{Condition, ModelSettings};
use serde::Serialize;
use toml::Table;

/// Model-specific part of a case, which is passed on to the model as TOML text.
#[derive(Serialize)]
struct ModelSettingsToml<'a> {
    /// Table `[model]` of the case file without its key `kind`.
    model: &'a Table,
    /// Tables `[[conditions]]` of the case file without their key `name`.
    conditions: Vec<&'a Table>,
}

/// Reads the names of the conditions.
///
/// # Errors
/// Returns an error if there is no condition, a name occurs twice or a name has characters that are not
/// allowed.
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

/// Returns the model-specific part of the case in the form that is sent to workers.
pub(super) fn settings(model: &ModelEntry, conditions: &[ConditionEntry]) -> ModelSettings {
    let own = ModelSettingsToml {
        model: &model.own,
        conditions: conditions.iter().map(|entry| &entry.own).collect(),
    };
    // what was read as TOML can be written as TOML
    let text = toml::to_string(&own).unwrap_or_default();
    ModelSettings::exact(model.kind.clone(), text.into_bytes())
}
