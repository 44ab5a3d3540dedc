//! Differences between two runs, described in words.
use crate::event::RunHeader;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Maximum number of differing settings that are named individually.
const MOST_NAMED: usize = 3;

/// Describes how command, case and settings of an existing run differ from those with which it is opened.
pub(super) fn differences(was: &RunHeader, is: &RunHeader) -> Vec<String> {
    let mut what = Vec::new();
    if was.kind != is.kind {
        what.push(format!("command ({}, now {})", was.kind, is.kind));
    }
    if was.case != is.case {
        let (was, is) = (was.case.to_string(), is.case.to_string());
        let short = |hash: &str| hash.get(..12).unwrap_or_default().to_owned();
        what.push(format!(
            "case (content {}, now {})",
            short(&was),
            short(&is)
        ));
    }
    if was.settings != is.settings {
        what.extend(setting_differences(&was.settings, &is.settings));
    }
    what
}

fn setting_differences(was: &str, is: &str) -> Vec<String> {
    let (was, is) = (leaves(was), leaves(is));
    let names: BTreeSet<&String> = was.keys().chain(is.keys()).collect();
    let show = |value: Option<&String>| value.map_or("none", String::as_str).to_owned();
    let mut what: Vec<String> = names
        .into_iter()
        .filter(|name| was.get(*name) != is.get(*name))
        .map(|name| {
            format!(
                "{name} ({}, now {})",
                show(was.get(name)),
                show(is.get(name))
            )
        })
        .collect();
    if what.len() > MOST_NAMED {
        let more = what.len() - MOST_NAMED;
        what.truncate(MOST_NAMED);
        what.push(format!("{more} more settings"));
    }
    if what.is_empty() {
        what.push("format of its settings (their values are equal)".to_owned());
    }
    what
}

/// Flattens settings to values by path, e.g. `search.population`.
fn leaves(text: &str) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    match serde_json::from_str(text) {
        Ok(value) => collect("", &value, &mut found),
        Err(_) => drop(found.insert("setting".to_owned(), text.to_owned())),
    }
    found
}

fn collect(path: &str, value: &Value, found: &mut BTreeMap<String, String>) {
    let below = |name: &str| match path {
        "" => name.to_owned(),
        _ => format!("{path}.{name}"),
    };
    match value {
        Value::Object(fields) => {
            for (name, value) in fields {
                collect(&below(name), value, found);
            }
        }
        Value::Array(values) => {
            for (index, value) in values.iter().enumerate() {
                collect(&below(&(index + 1).to_string()), value, found);
            }
        }
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {
            let name = if path.is_empty() { "setting" } else { path };
            found.insert(name.to_owned(), value.to_string());
        }
    }
}
