//! Tests of the export target: existing foreign files are preserved, and an incomplete export is never
//! visible.
use super::{Exported, Format, Store, StoreError, Target, read_back, table::NAMES};
use protocol::case::Case;
use std::{fs, path::Path};

fn case() -> Case {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb");
    case::load(&folder, &case::Overrides::default()).unwrap()
}

fn target(path: &Path, format: Format, force: bool) -> Target {
    Target {
        path: path.to_owned(),
        format,
        force,
    }
}

fn write(path: &Path, format: Format, force: bool) -> Result<Exported, StoreError> {
    let case = case();
    Store::begin(target(path, format, force), &case)?.finish()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn every_table_is_known_by_name_and_in_the_dictionary() {
    let scratch = tempfile::tempdir().unwrap();
    let made = write(&scratch.path().join("csv"), Format::Csv, false).unwrap();
    let mut known = NAMES.to_vec();
    known.sort_unstable();
    assert_eq!(made.rows.keys().copied().collect::<Vec<_>>(), known);
    let tables = read_back::tables(&scratch.path().join("csv"), Format::Csv);
    let (_, dictionary) = &tables["dictionary"];
    let columns: usize = tables.values().map(|(names, _)| names.len()).sum();
    assert_eq!(dictionary.len(), columns);
    for (name, (columns, _)) in &tables {
        let mut once = columns.clone();
        once.sort();
        once.dedup();
        assert_eq!(once.len(), columns.len(), "{name} has a column twice");
    }
}

#[test]
fn what_is_ours_is_replaced_and_nothing_else() {
    let scratch = tempfile::tempdir().unwrap();
    for format in [Format::Sqlite, Format::Csv, Format::Parquet] {
        let place = scratch.path().join(format.as_str());
        let first = write(&place, format, false).unwrap();
        assert_eq!(write(&place, format, false).unwrap(), first);
        // a file of somebody's in its place
        let file = scratch.path().join(format!("{}.txt", format.as_str()));
        fs::write(&file, "SQLite format 3\0 it is not").unwrap();
        let refused = write(&file, format, false).unwrap_err();
        assert!(matches!(refused, StoreError::Foreign { .. }), "{refused}");
        assert_eq!(fs::read(&file).unwrap(), b"SQLite format 3\0 it is not");
    }
    // somebody's database
    let other = scratch.path().join("other.sqlite");
    let database = rusqlite::Connection::open(&other).unwrap();
    database.execute_batch("CREATE TABLE mine (a)").unwrap();
    drop(database);
    let before = fs::read(&other).unwrap();
    write(&other, Format::Sqlite, false).unwrap_err();
    assert_eq!(fs::read(&other).unwrap(), before);
    write(&other, Format::Sqlite, true).unwrap();
    assert!(read_back::tables(&other, Format::Sqlite).contains_key("run"));
    // somebody's file among ours, and a folder of somebody's
    let place = scratch.path().join("csv");
    fs::write(place.join("notes.txt"), "keep").unwrap();
    write(&place, Format::Csv, false).unwrap_err();
    fs::remove_file(place.join("genes.csv")).unwrap();
    write(&place, Format::Csv, true).unwrap();
    assert_eq!(fs::read(place.join("notes.txt")).unwrap(), b"keep");
    assert!(place.join("genes.csv").exists());
    let theirs = scratch.path().join("theirs");
    fs::create_dir(&theirs).unwrap();
    fs::write(theirs.join("genes.csv"), "a,b").unwrap();
    write(&theirs, Format::Csv, false).unwrap_err();
    assert_eq!(names(&theirs), ["genes.csv"]);
    // nothing is left lying about
    let hidden = names(scratch.path());
    assert!(
        hidden.iter().all(|name| !name.starts_with('.')),
        "{hidden:?}"
    );
}

#[test]
fn a_place_that_cannot_be_written_is_named() {
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("file");
    fs::write(&file, "").unwrap();
    for format in [Format::Sqlite, Format::Csv, Format::Parquet] {
        let refused = write(&file.join("below/it"), format, false).unwrap_err();
        assert!(refused.to_string().contains("below/it"), "{refused}");
    }
    // a folder where the database should go, whatever is said
    for force in [false, true] {
        write(scratch.path(), Format::Sqlite, force).unwrap_err();
    }
    assert_eq!(names(scratch.path()), ["file"]);
}

#[test]
fn an_export_that_is_given_up_leaves_the_old_one() {
    let scratch = tempfile::tempdir().unwrap();
    let place = scratch.path().join("run.sqlite");
    write(&place, Format::Sqlite, false).unwrap();
    let before = fs::read(&place).unwrap();
    let case = case();
    let mut store = Store::begin(target(&place, Format::Sqlite, false), &case).unwrap();
    store.fact("a", "b").unwrap();
    store.journal(&scratch.path().join("nowhere")).unwrap_err();
    assert_eq!(fs::read(&place).unwrap(), before);
    drop(store);
    assert_eq!(fs::read(&place).unwrap(), before);
    assert_eq!(names(scratch.path()), ["run.sqlite"]);
}
