//! A finished run is shown by its folder alone: without its case, and without a worker. A run whose journal ends after
//! any record comes to the same entries of its study.
use crate::{rig::Rig, swept::ROWS};
use journal::{event::Event, fold};
use serde_json::Value;
use std::{collections::BTreeMap, fs, path::Path};

/// Writes the files of a run again, and returns these, what is printed, and its tables.
fn shown(rig: &Rig, run: &str) -> BTreeMap<String, Vec<u8>> {
    let path = rig.path(run);
    let printed = rig.run(&["report", &path, "--output", "json"]);
    let (tables, format) = (rig.path("tables"), "csv");
    let to = ["--format", format, "--to", &tables, "--force"];
    rig.run(&[&["export", &path], &to[..]].concat());
    let names = ["report.html", "tables.txt", "sweep.csv", "result.json"];
    let files = names.map(|name| rig.file(run).join(name)).into_iter();
    let exported = fs::read_dir(&tables).unwrap();
    let exported = exported.map(|entry| entry.unwrap().path());
    let there = files.filter(|file| file.exists()).chain(exported);
    let read = there.map(|file| {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        (name, fs::read(&file).unwrap())
    });
    let printed = ("printed".to_owned(), printed.into_bytes());
    let all: BTreeMap<String, Vec<u8>> = read.chain([printed]).collect();
    assert!(
        all.contains_key("result.json") && all.contains_key("report.html") && all.len() >= 12,
        "{:?}",
        all.keys()
    );
    all
}

#[test]
fn a_run_is_shown_without_its_case_and_without_workers() {
    let rig = Rig::new();
    let grid = "preset = \"random\"\nevaluations = 20\nseeds = [1, 2]\n[grid]\npoints = [20, 30]\n";
    fs::write(rig.file("grid.toml"), grid).unwrap();
    fs::write(rig.file("table.csv"), ROWS).unwrap();
    let (grid, table, case) = (
        rig.path("grid.toml"),
        rig.path("table.csv"),
        rig.path("case"),
    );
    let factors = "population=8,12,16;mutation_probability=0.02,0.05,0.1";
    let runs: [(&str, &[&str]); 6] = [
        ("calibrated", &["calibrate", "CASE"]),
        ("diagnosed", &["diagnose", "CASE"]),
        ("identified", &["identify", "CASE"]),
        ("grid", &["sweep", &grid, "--case", &case]),
        ("table", &["sweep", &table, "--case", &case]),
        (
            "tested",
            &[
                "sweep",
                "orthogonal",
                "CASE",
                "--evaluations=30",
                "--seeds=2",
                "--factor",
                factors,
            ],
        ),
    ];
    let before = runs.map(|(run, words)| {
        let path = rig.path(run);
        rig.run(&[words, &["--run", &path]].concat());
        shown(&rig, run)
    });
    fs::remove_dir_all(&case).unwrap();
    for file in [&grid, &table] {
        fs::remove_file(file).unwrap();
    }
    rig.without_worker();
    for ((run, _), before) in runs.into_iter().zip(before) {
        let after = shown(&rig, run);
        let names = |all: &BTreeMap<String, Vec<u8>>| all.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&before), names(&after));
        for (name, content) in before {
            assert!(after[&name] == content, "{run}: {name} differs");
        }
    }
}

/// Checks that the request of a job that damage has taken is written again when the run is resumed.
#[test]
fn a_damaged_request_is_written_again() {
    let rig = Rig::new();
    let path = rig.path("run");
    let words = ["calibrate", "CASE", "--run", &path];
    rig.run(&words);
    let journal = rig.file("run").join(journal::FILE);
    let mut requests = Vec::new();
    fold(&journal, |at, event| {
        if matches!(event, Event::Asked(_)) {
            requests.push(usize::try_from(at.at).unwrap());
        }
    })
    .unwrap();
    let mut bytes = fs::read(&journal).unwrap();
    bytes[requests[requests.len() / 2]] ^= 1;
    fs::write(&journal, bytes).unwrap();
    let result = rig.file("run").join("result.json");
    let digest = |file: &Path| {
        let object: Value = serde_json::from_slice(&fs::read(file).unwrap()).unwrap();
        object["log_digest"].clone()
    };
    let before = digest(&result);
    let refused = rig.refused(&["report", &path]);
    assert!(refused.contains("lacks results"), "{refused}");
    rig.run(&words);
    fs::remove_file(&result).unwrap();
    rig.run(&["report", &path]);
    assert_eq!(digest(&result), before);
}

/// Returns the entries of the study in a journal by number, and the offset of the end of each record.
fn recorded(journal: &Path) -> (BTreeMap<u64, Vec<u8>>, Vec<u64>) {
    let (mut entries, mut ends) = (BTreeMap::new(), Vec::new());
    fold(journal, |at, event| {
        ends.push(at.at + u64::from(at.length));
        if let Event::Found { number, entry } = event {
            let earlier = entries.insert(number, entry.into_vec());
            assert!(earlier.is_none(), "entry {number} is written twice");
        }
    })
    .unwrap();
    (entries, ends)
}

#[test]
fn a_run_cut_after_any_record_comes_to_the_same_entries() {
    /// Number of records after which each journal is cut.
    const CUTS: usize = 5;
    let rig = Rig::new();
    for command in ["calibrate", "diagnose"] {
        let (run, path) = (rig.file(command), rig.path(command));
        let words = [command, "CASE", "--run", &path];
        rig.run(&words);
        let journal = run.join(journal::FILE);
        let (entries, ends) = recorded(&journal);
        let whole = fs::read(&journal).unwrap();
        let cut_at = |cut: usize| ends[(cut + 1) * ends.len() / (CUTS + 1)];
        // within the search, and right before and after the conclusion
        let last = [ends.len() - 4, ends.len() - 3, ends.len() - 2].map(|at| ends[at]);
        for end in (0..CUTS).map(cut_at).chain(last) {
            let kept = usize::try_from(end).unwrap();
            fs::write(&journal, &whole[..kept]).unwrap();
            rig.run(&words);
            let (again, _) = recorded(&journal);
            assert!(again == entries, "{command}, cut at {end}");
        }
    }
}
