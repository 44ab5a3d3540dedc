//! Readers of finished runs: what they show is read from journals, and no study is executed again.
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Folders and files of the readers of runs. The simulator of the dashboard is none of them: it computes what no run has.
const READERS: [&str; 11] = [
    "coordinator/dashboard/src/folder.rs",
    "coordinator/dashboard/src/follow.rs",
    "coordinator/dashboard/src/sections.rs",
    "coordinator/dashboard/src/state.rs",
    "coordinator/report/src",
    "coordinator/store/src",
    "coordinator/src/cli/output",
    "coordinator/src/cli/command/report.rs",
    "coordinator/src/cli/command/export",
    "coordinator/run/src/tables.rs",
    "coordinator/run/src/view.rs",
];

/// Words of the code that executes a study.
const EXECUTES: [&str; 14] = [
    "replay(",
    "Evaluator::new(",
    ": Evaluator",
    "calibrate_case(",
    "calibrate(",
    "compare(",
    "check_records(",
    "diagnose(",
    "diagnose_on(",
    "estimate_at_start_on(",
    "identify(",
    "identify_on(",
    "score_all(",
    "Sweep::new(",
];

/// Returns the source files at a path or below it.
fn sources(path: &Path) -> Vec<PathBuf> {
    if path.is_file() {
        return vec![path.to_owned()];
    }
    let entries = fs::read_dir(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let below = entries.map(|entry| sources(&entry.unwrap().path()));
    below.flatten().collect()
}

#[test]
fn no_reader_executes_a_study() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut read = 0;
    for path in READERS
        .iter()
        .flat_map(|reader| sources(&root.join(reader)))
    {
        // tests make the runs that they read
        let is_tests = path.file_name().is_some_and(|name| name == "tests.rs");
        if is_tests || path.extension().is_none_or(|ending| ending != "rs") {
            continue;
        }
        read += 1;
        for line in fs::read_to_string(&path).unwrap().lines() {
            let code = line.split("//").next().unwrap_or_default();
            let found = EXECUTES.iter().find(|word| code.contains(**word));
            assert!(found.is_none(), "{}: {line}", path.display());
        }
    }
    assert!(read > 100, "{read} files");
}
