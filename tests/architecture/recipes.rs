//! Checks that every file named in the recipes of `coordinator/README.md` exists.
use std::path::{Path, PathBuf};

/// Collects all files below a folder.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in folder.read_dir().expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, found);
        } else {
            found.push(path);
        }
    }
}

/// Returns the parts of a text between backquotes.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

#[test]
fn recipes_name_files_that_exist() {
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut known = Vec::new();
    for folder in ["coordinator", "protocol", "worker"] {
        files(&base.join(folder), &mut known);
    }
    let text = std::fs::read_to_string(base.join("coordinator/README.md")).expect("the README");
    let (_, recipes) = text.split_once("## What a new one costs").expect("recipes");
    let rows = recipes.lines().filter(|line| line.starts_with("| "));
    let mut checked = 0;
    // a heading comes first
    for row in rows.skip(1) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').collect();
        let [what, _, change, example] = cells[..] else {
            panic!("four cells are expected: {row}");
        };
        let named = |name: &str| known.iter().any(|path| path.ends_with(name));
        for name in quoted(change).chain(quoted(example)) {
            assert!(name.ends_with('/') || named(name), "{what}: no {name}");
        }
        checked += 1;
    }
    assert!(checked >= 7, "{checked} recipes");
}
