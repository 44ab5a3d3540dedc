//! Filling of a record's data sheet with what an import measured; comments and other keys stay.
use crate::{
    document::Document,
    error::{CaseError, damaged},
};
use toml_edit::{DocumentMut, Item, Table, Value};

/// Sets keys of a data sheet: table (empty for the top level), key and value. A key that stands commented out
/// becomes a key in its place.
///
/// # Errors
/// Returns an error for a sheet that is not TOML, or in which a table's name is something else.
pub(super) fn fill(
    document: &Document,
    values: &[(&str, &str, Value)],
) -> Result<String, CaseError> {
    let mut text = document.text().to_owned();
    for (table, key, value) in values {
        text = uncommented(&text, table, key, value);
    }
    let mut sheet: DocumentMut = text.parse().map_err(|error| {
        damaged(
            &document.path,
            format!("it is not valid TOML: {error}"),
            "correct it, or remove it: the import writes a new one",
        )
    })?;
    for (table, key, value) in values {
        let place = if table.is_empty() {
            Some(sheet.as_table_mut())
        } else {
            let place = sheet.entry(table).or_insert(Item::Table(Table::new()));
            place.as_table_mut()
        };
        let Some(place) = place else {
            return Err(damaged(
                &document.path,
                format!("`{table}` is not a table"),
                "write it as `[NAME]` with its keys below",
            ));
        };
        match place.get_mut(key).and_then(Item::as_value_mut) {
            Some(there) => {
                let mut decor = there.decor().clone();
                // the remark after the value stays in its column
                let remark = decor.suffix().and_then(toml_edit::RawString::as_str);
                if let Some((blanks, remark)) = remark.and_then(|suffix| suffix.split_once('#')) {
                    let before = there.clone().decorated("", "").to_string().len();
                    let after = value.clone().decorated("", "").to_string().len();
                    let width = (before + blanks.len()).saturating_sub(after);
                    decor.set_suffix(format!("{:width$}#{remark}", "", width = width.max(1)));
                }
                *there = value.clone();
                *there.decor_mut() = decor;
            }
            None => {
                place.insert(key, Item::Value(value.clone()));
            }
        }
    }
    Ok(sheet.to_string())
}

/// Removes the comment sign before a key of a table, if the key stands only there.
fn uncommented(text: &str, table: &str, key: &str, value: &Value) -> String {
    let mut current = "";
    let (mut found, mut commented) = (false, None);
    let lines: Vec<&str> = text.lines().collect();
    let starts = |line: &str| {
        line.split_once('=')
            .is_some_and(|(name, _)| name.trim() == key)
    };
    for (at, line) in lines.iter().enumerate() {
        let bare = line.trim_start();
        if let Some(name) = bare.strip_prefix('[') {
            current = name.split(']').next().unwrap_or_default().trim();
        }
        if current == table {
            found |= starts(bare);
            if bare.strip_prefix('#').is_some_and(starts) {
                commented.get_or_insert(at);
            }
        }
    }
    let Some(at) = commented.filter(|_| !found) else {
        return text.to_owned();
    };
    let mut lines: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
    if let Some(line) = lines.get_mut(at) {
        let bare = line.trim_start().trim_start_matches('#').trim_start();
        let remark = bare
            .split_once('#')
            .map(|(before, remark)| (before.len(), remark));
        let value = value.to_string();
        let plain = format!("{key} = {}", value.trim());
        *line = match remark {
            None => plain,
            Some((width, remark)) => format!("{plain:<width$}#{remark}", width = width + 2),
        };
    }
    lines.join("\n") + "\n"
}
