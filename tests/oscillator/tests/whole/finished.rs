//! A finished run is shown by its folder alone: without its case, and without a worker.
use crate::rig::Rig;
use std::{collections::BTreeMap, fs};

/// Names of the files of a finished run that `report` writes.
const FILES: [&str; 3] = ["report.html", "tables.txt", "result.json"];

/// Writes the files of a run again, and returns these, what is printed, and its tables.
fn shown(rig: &Rig, run: &str) -> BTreeMap<String, Vec<u8>> {
    let path = rig.path(run);
    let printed = rig.run(&["report", &path, "--output", "json"]);
    rig.run(&[
        "export",
        &path,
        "--format",
        "csv",
        "--to",
        &rig.path("tables"),
        "--force",
    ]);
    let folder = fs::read_dir(rig.file("tables")).unwrap();
    let tables = folder.map(|entry| entry.unwrap().path());
    let files = FILES.map(|name| rig.file(run).join(name)).into_iter();
    let read = files.chain(tables).map(|file| {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        (name, fs::read(&file).unwrap())
    });
    let printed = ("printed".to_owned(), printed.into_bytes());
    read.chain([printed]).collect()
}

#[test]
fn a_run_is_shown_without_its_case_and_without_workers() {
    let rig = Rig::new();
    let runs: [&[&str]; 3] = [
        &["calibrate", "CASE", "--run", "calibrated"],
        &["diagnose", "CASE", "--run", "diagnosed"],
        &["identify", "CASE", "--run", "identified"],
    ];
    for words in runs {
        rig.run(words);
    }
    let names = runs.map(|words| words.last().unwrap());
    let before = names.map(|run| shown(&rig, run));
    fs::remove_dir_all(rig.file("case")).unwrap();
    rig.without_worker();
    for (run, before) in names.into_iter().zip(before) {
        let after = shown(&rig, run);
        assert_eq!(
            before.keys().collect::<Vec<_>>(),
            after.keys().collect::<Vec<_>>()
        );
        for (name, content) in before {
            assert!(after[&name] == content, "{run}: {name} differs");
        }
    }
}
