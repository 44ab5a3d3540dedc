//! Writing of effects and start values to a case file as TOML, preserving the file's comments and layout.
//! Effects read back from the text are bit-identical.
use super::{
    effect::{CaseEffect, CaseParameter, Provenance},
    error::{CaseError, damaged},
    file,
};
use std::path::Path;
use support::atomic_file;
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, Value, value};

/// Returns effects as the text of `[[effects]]` tables; empty if there are no effects.
pub fn write_effects(effects: &[CaseEffect]) -> String {
    let mut document = DocumentMut::new();
    if !effects.is_empty() {
        document.insert("effects", tables(ArrayOfTables::new(), effects));
    }
    document.to_string()
}

/// Appends effects to those of a case file. The file is replaced atomically, so that concurrent readers see
/// either the old or the new version.
///
/// # Errors
/// Returns an error if the file is missing, is not valid TOML or cannot be replaced, or if its `effects` is
/// not an array of tables.
pub fn append_effects(path: &Path, effects: &[CaseEffect]) -> Result<(), CaseError> {
    edit(path, |document| {
        // removed and put back: the order in the text is kept by the tables themselves
        let there = match document.remove("effects") {
            None => ArrayOfTables::new(),
            Some(Item::Value(Value::Array(none))) if none.is_empty() => ArrayOfTables::new(),
            Some(there) => there.into_array_of_tables().map_err(|other| {
                damaged(
                    path,
                    format!("`effects` is {}, not a list of tables", other.type_name()),
                    "write every effect as a table [[effects]], or remove `effects`",
                )
            })?,
        };
        document.insert("effects", tables(there, effects));
        Ok(())
    })
}

/// Replaces the start values of unknowns, given by name, in a case file; the file is replaced atomically.
///
/// # Errors
/// Returns an error if the file is missing, is not valid TOML, lacks one of the unknowns or cannot be
/// replaced.
pub fn write_starts(path: &Path, starts: &[(String, f64)]) -> Result<(), CaseError> {
    edit(path, |document| {
        let tables = document
            .get_mut("unknowns")
            .and_then(Item::as_array_of_tables_mut);
        let mut tables: Vec<&mut Table> =
            tables.into_iter().flat_map(|all| all.iter_mut()).collect();
        for (name, start) in starts {
            let place = tables
                .iter()
                .position(|table| table.get("name").and_then(Item::as_str) == Some(name));
            let Some(table) = place.and_then(|place| tables.get_mut(place)) else {
                return Err(damaged(
                    path,
                    format!("there is no [[unknowns]] table of the name `{name}`"),
                    "add it with `start`, or diagnose the case as it is now",
                ));
            };
            let mut new = Value::from(*start);
            if let Some(old) = table.get("start").and_then(Item::as_value) {
                // comments behind it stay
                *new.decor_mut() = old.decor().clone();
            }
            table.insert("start", Item::Value(new));
        }
        Ok(())
    })
}

/// Edits a case file and replaces it atomically; comments and layout are preserved.
fn edit(
    path: &Path,
    change: impl FnOnce(&mut DocumentMut) -> Result<(), CaseError>,
) -> Result<(), CaseError> {
    let text = file::text(path, file::read(path, "the case that is added to")?)?;
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
        damaged(
            path,
            format!("nothing can be added: {}", error.message()),
            "correct the file (`horsehead case check` shows the place), then add again",
        )
    })?;
    change(&mut document)?;
    atomic_file::replace(path, document.to_string().as_bytes()).map_err(|source| {
        CaseError::Unwritable {
            path: path.into(),
            source,
        }
    })
}

/// Appends `[[effects]]` tables of the given effects to those of a case file.
fn tables(mut there: ArrayOfTables, effects: &[CaseEffect]) -> Item {
    for effect in effects {
        there.push(table(effect));
    }
    Item::ArrayOfTables(there)
}

/// Returns an effect as an `[[effects]]` table with one line per key, preceded by an empty line.
fn table(effect: &CaseEffect) -> Table {
    let numbers = effect.parameters.iter();
    let numbers: InlineTable = numbers.map(|(name, p)| (name, parameter(p))).collect();
    let mut table = Table::new();
    table.insert("id", value(&effect.id));
    table.insert("parameters", value(numbers));
    if let Some(from) = &effect.provenance {
        table.insert("provenance", value(provenance(from)));
    }
    table.decor_mut().set_prefix("\n");
    table
}

fn parameter(parameter: &CaseParameter) -> InlineTable {
    let interval = |interval: Option<[f64; 2]>| interval.map(|i| Value::from(Array::from_iter(i)));
    present([
        ("value", Some(parameter.value.into())),
        ("unit", Some((&parameter.unit).into())),
        ("ci95", interval(parameter.ci95)),
        ("search", interval(parameter.search)),
    ])
}

fn provenance(from: &Provenance) -> InlineTable {
    let text = |text: &Option<String>| text.as_ref().map(Value::from);
    let set = (!from.set.is_empty()).then(|| Value::from(Array::from_iter(&from.set)));
    present([
        ("dataset", text(&from.dataset)),
        ("run", text(&from.run)),
        ("verdict", text(&from.verdict)),
        ("set", set),
        ("ln_evidence_gain", from.ln_evidence_gain.map(Value::from)),
        ("round", from.round.map(|round| i64::from(round).into())),
    ])
}

/// Builds a TOML inline table from the given key-value pairs, without those whose value is absent.
fn present<const N: usize>(parts: [(&str, Option<Value>); N]) -> InlineTable {
    let parts = parts.into_iter();
    parts.filter_map(|(key, part)| Some((key, part?))).collect()
}

#[cfg(test)]
mod tests {
    use super::{append_effects, write_effects, write_starts};
    use crate::effect::{CaseEffect, CaseParameter, Provenance};
    use serde::Deserialize;
    use std::{collections::BTreeMap, fs};

    #[derive(Deserialize)]
    struct File {
        effects: Vec<CaseEffect>,
    }

    fn effects() -> Vec<CaseEffect> {
        let number = |value: f64, ci95: Option<[f64; 2]>| CaseParameter {
            value,
            unit: "N.m".to_owned(),
            ci95,
            search: ci95.map(|[low, high]| [2.0 * low, 0.1 + 2.0 * high]),
        };
        vec![
            CaseEffect {
                id: "pivot_friction".to_owned(),
                parameters: BTreeMap::from([
                    ("moment".to_owned(), number(1234.5678901234567, None)),
                    (
                        "viscous".to_owned(),
                        number(-1.5e-17, Some([-2e300, 0.1 + 0.2])),
                    ),
                ]),
                provenance: Some(Provenance {
                    dataset: Some("sha256:0f".to_owned()),
                    run: Some("a \"quoted\" run\\".to_owned()),
                    verdict: Some("ambiguous".to_owned()),
                    set: vec![
                        "pivot_friction".to_owned(),
                        "stuffing_box_friction".to_owned(),
                    ],
                    ln_evidence_gain: Some(214.0),
                    round: Some(2),
                }),
            },
            CaseEffect {
                id: "gauge_gain".to_owned(),
                provenance: Some(Provenance::default()),
                ..CaseEffect::default()
            },
            CaseEffect {
                id: "probe.saddle.v".to_owned(),
                ..CaseEffect::default()
            },
        ]
    }

    #[test]
    fn what_is_written_reads_back_to_the_bit() {
        let text = write_effects(&effects());
        let back: File = toml::from_str(&text).unwrap_or_else(|e| unreachable!("{e}\n{text}"));
        assert_eq!(back.effects, effects(), "{text}");
        let lines = |start: &str| text.lines().filter(|line| line.starts_with(start)).count();
        assert_eq!((lines("[["), lines("id = ")), (3, 3), "{text}");
        assert_eq!((lines("parameters = {"), lines("provenance = {")), (3, 2));
        assert!(write_effects(&[]).is_empty());
    }

    /// Checks that comments, order, spaces and a comment after the last line are preserved.
    #[test]
    fn the_users_file_keeps_its_comments_and_layout() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("case.toml");
        let own = "# mine\nname   = \"a\"   # padded\n\n[[effects]]  # by hand\nid = \"x\"\n\n[run]\n\
                   modes = 6\n# the end";
        fs::write(&file, own).unwrap();
        append_effects(&file, &effects()).unwrap();
        let text = fs::read_to_string(&file).unwrap();
        for line in own.lines() {
            assert!(text.contains(line), "no `{line}` in\n{text}");
        }
        let back: File = toml::from_str(&text).unwrap();
        assert_eq!(back.effects[0].id, "x");
        assert_eq!(back.effects[1..], effects());
        let run = text.find("[run]").unwrap();
        assert!(text.find("probe.saddle.v").unwrap() < run, "{text}");

        fs::write(&file, own.replace("[[effects]]  # by hand\nid = \"x\"", "")).unwrap();
        append_effects(&file, &effects()).unwrap();
        let text = fs::read_to_string(&file).unwrap();
        let back: File = toml::from_str(&text).unwrap();
        assert_eq!(back.effects, effects(), "{text}");
        assert!(text.starts_with("# mine\nname   = \"a\"   # padded\n"));
    }

    #[test]
    fn a_file_that_cannot_take_effects_is_refused_and_kept() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("case.toml");
        for (text, problem) in [
            ("effects = 3\n", "`effects` is integer"),
            ("name = \n", "nothing can be added"),
        ] {
            fs::write(&file, text).unwrap();
            let said = append_effects(&file, &effects()).unwrap_err().to_string();
            assert!(
                said.contains(problem) && said.contains("case.toml"),
                "{said}"
            );
            assert!(said.contains("\nhelp: "), "{said}");
            assert_eq!(fs::read_to_string(&file).unwrap(), text);
        }
        fs::write(&file, "effects = []\n").unwrap();
        append_effects(&file, &effects()).unwrap();
        let back: File = toml::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
        assert_eq!(back.effects, effects());
    }

    /// Checks that replacing start values in a case file leaves everything else as written.
    #[test]
    fn a_start_is_replaced_where_it_stands() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("case.toml");
        let text = "# mine\n[[unknowns]]\nname = \"a\"\nstart = 1.0 # as drawn\n\n[[unknowns]]\nname = \"b\"\n";
        fs::write(&path, text).unwrap();
        write_starts(
            &path,
            &[("a".to_owned(), 0.1 + 0.2), ("b".to_owned(), -2.5)],
        )
        .unwrap();
        let expected = text.replace("1.0 #", "0.30000000000000004 #") + "start = -2.5\n";
        assert_eq!(fs::read_to_string(&path).unwrap(), expected);
        let refused = write_starts(&path, &[("c".to_owned(), 1.0)]).unwrap_err();
        assert!(
            refused
                .to_string()
                .contains("no [[unknowns]] table of the name `c`")
        );
        assert_eq!(fs::read_to_string(&path).unwrap(), expected);
    }
}
