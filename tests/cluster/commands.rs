//! Tests of the commands from a case to its tables: a calibration that is killed and resumed, and cases
//! without recordings.
use super::LIMIT;
use rustix::process::Signal;
use serde_json::Value;
use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
};
use tests::process::{Process, coordinator_program, wait_until};

const POINTS: u64 = 12;
/// Length of the journal at which the test kills the calibration: a few results of some 28 kB are recorded
/// (bytes).
const SOME: u64 = 100_000;

/// Copies the shipped case with fewer, longer cylinders and edits its file line by line.
fn coarse_case(folder: &Path, edit: impl Fn(&str) -> String) {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    let case = folder.join("case");
    let copied = Command::new("cp")
        .arg("-r")
        .arg(shipped)
        .arg(&case)
        .status();
    assert!(copied.is_ok_and(|status| status.success()), "cp");
    let text = fs::read_to_string(case.join("case.toml")).unwrap();
    let coarse = text
        .replace("cylinder_length_m = 0.050", "cylinder_length_m = 0.150")
        .replace("back_cylinders = 72", "back_cylinders = 24")
        .replace("front_cylinders = 114", "front_cylinders = 38");
    let lines: Vec<String> = coarse.lines().map(edit).collect();
    fs::write(case.join("case.toml"), lines.join("\n")).unwrap();
}

fn horsehead(folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(coordinator_program());
    command.current_dir(folder).args(words);
    command.args(["--output", "json"]);
    command
}

/// Runs a `horsehead` command and returns the JSON object that it prints.
fn said(folder: &Path, words: &[&str]) -> Value {
    let output = horsehead(folder, words).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words:?}: {errors}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Removes run folder, wall time and files from the result of a calibration, so that results can be compared.
fn found(mut object: Value) -> Value {
    for key in ["run", "wall_s", "files"] {
        assert!(
            object.as_object_mut().unwrap().remove(key).is_some(),
            "{key}"
        );
    }
    object
}

#[test]
fn a_calibration_that_was_killed_finds_what_another_finds_and_is_told_and_exported() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    coarse_case(folder, str::to_owned);
    let points = format!("points={POINTS}");
    let settings = ["--preset", "random", "--set", &points, "--workers", "2"];
    let calibrate = |run| [&["calibrate", "case", "--run", run], &settings[..]].concat();
    let whole = found(said(folder, &calibrate("whole")));
    assert_eq!(whole["evaluations"], POINTS);

    let mut command = horsehead(folder, &calibrate("killed"));
    command.stderr(Stdio::null());
    let mut process = Process::start(command);
    let journal = folder.join("killed/journal.hhj");
    wait_until("some results are there", LIMIT, || {
        fs::metadata(&journal).is_ok_and(|file| file.len() > SOME)
    });
    process.signal(Signal::KILL);
    assert_eq!(process.wait(LIMIT), None, "it ended before");
    assert!(!folder.join("killed/result.json").exists());
    assert_eq!(found(said(folder, &calibrate("killed"))), whole);
    assert_eq!(found(said(folder, &["report", "killed"])), whole);

    // each individual of the search, and what the report adds to it
    let rows = ["whole", "killed"].map(|run| {
        let tables = said(
            folder,
            &[
                "export",
                run,
                "--format",
                "csv",
                "--to",
                &format!("{run} tables"),
            ],
        );
        assert_eq!(tables["complete"], true);
        tables["rows"]["results"].as_u64().unwrap()
    });
    assert!(rows[0] > POINTS && rows[0] == rows[1], "{rows:?}");
    let results = fs::read_to_string(folder.join("killed tables/results.csv")).unwrap();
    assert_eq!(results.lines().count() as u64, 1 + rows[1]);
}

#[test]
fn a_case_without_records_is_checked_and_simulated() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let without = |line: &str| match line.split_once('=') {
        Some((key, _)) if key.trim() == "record_file" => String::new(),
        _ => line.to_owned(),
    };
    coarse_case(folder, without);
    let checked = said(folder, &["case", "check", "case"]);
    assert_eq!(checked["conditions"].as_array().unwrap().len(), 2);
    let simulated = said(folder, &["simulate", "case"]);
    assert_eq!(simulated["verdict"], "complete");
    let stress = simulated["gauge_mpa"]["1"].as_array().unwrap();
    assert_eq!(stress.len(), 720);
    assert!(stress.iter().all(Value::is_number));
    // what each of these changes, and what has no effect says so
    let asked = [
        "simulate",
        "case",
        "--derivatives",
        "kb1,kb4,pivot_friction.moment",
        "--out",
        "derived",
    ];
    let derived = said(folder, &asked);
    assert_eq!(derived["digest"], simulated["digest"]);
    assert!(derived["wall_s"].is_number() && derived["derivatives_wall_s"].is_number());
    let by = &derived["derivatives"];
    assert_eq!(by.as_object().unwrap().len(), 3);
    assert_eq!(by["kb1"]["unit"], "MPa per decade");
    assert_eq!(by["pivot_friction.moment"]["unit"], "MPa per N.m");
    for gauge in ["1", "2", "3", "4"] {
        let curve = by["kb1"]["gauge_mpa"][gauge].as_array().unwrap();
        assert_eq!(curve.len(), 720);
        assert!(curve.iter().any(|x| x.as_f64().unwrap().abs() > 1e-3));
    }
    assert_eq!(by["kb4"]["nothing"], true);
    let table = fs::read_to_string(folder.join("derived/derivatives.csv")).unwrap();
    assert!(table.lines().count() > 720, "{table}");
    let report = fs::read_to_string(folder.join("derived/report.html")).unwrap();
    assert!(report.contains("Derivatives of the curves"));
    let unknown = ["simulate", "case", "--derivatives", "kb1,kb7"];
    let refused = horsehead(folder, &unknown).output().unwrap();
    let words = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{words}");
    assert!(
        words.contains("`kb7` is not an unknown") && words.contains("kb1, kb23"),
        "{words}"
    );
    // nothing to compare it with
    let refused = horsehead(folder, &["calibrate", "case"]).output().unwrap();
    let words = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{words}");
    assert!(words.contains("record"), "{words}");
}
