//! Tests with a Python model that has five candidate effects, one of which acts in the measured records but
//! is absent from the case.
use crate::rig::Rig;
use std::fs;

/// True hardening coefficient of the spring, with which the measured records were generated [1/mm2].
const HARDENING: f64 = 0.012;

#[test]
fn a_hidden_effect_is_found_among_five_suspects_and_added() {
    let rig = Rig::of("bench");
    let answer = rig.object(&["diagnose", "case", "--run", "run", "--add"]);
    assert_eq!(answer["verdict"], "named", "{answer}");
    let effect = &answer["effects"][0];
    assert_eq!(effect["id"], "hardening", "{answer}");
    let text = fs::read_to_string(rig.file("case/case.toml")).unwrap();
    let own = text.split("name = \"hardening\"").nth(1).unwrap();
    let start = own
        .lines()
        .find_map(|line| line.strip_prefix("start = "))
        .unwrap();
    let start: f64 = start.parse().unwrap();
    assert!((start / HARDENING - 1.0).abs() < 0.1, "{start}");
    // comments of the file stay, and the case is one that can be calibrated
    assert!(text.starts_with("# A mass on a spring"));
    rig.done(&["case", "check", "case"]);
    assert_eq!(rig.left(), Vec::<String>::new());
}

/// Checks that the log digest is the same for one worker, three workers, and a run resumed from a truncated
/// journal.
#[test]
fn results_do_not_depend_on_workers_nor_on_interruptions() {
    let rig = Rig::of("bench");
    let words = |run: &'static str, workers: &'static str| {
        [
            "calibrate",
            "case",
            "--preset",
            "descent",
            "--run",
            run,
            "--workers",
            workers,
        ]
    };
    let one = rig.object(&words("one", "1"));
    let three = rig.object(&words("three", "3"));
    assert_eq!(one["log_digest"], three["log_digest"]);
    assert!(one["log_digest"].is_string(), "{one}");
    // the journal without its last third is that of a run that was killed
    let journal = rig.file("three/journal.hhj");
    let bytes = fs::read(&journal).unwrap();
    fs::create_dir(rig.file("cut")).unwrap();
    for entry in fs::read_dir(rig.file("three")).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            fs::copy(&path, rig.file("cut").join(path.file_name().unwrap())).unwrap();
        }
    }
    fs::write(rig.file("cut/journal.hhj"), &bytes[..2 * bytes.len() / 3]).unwrap();
    let again = rig.object(&words("cut", "2"));
    assert_eq!(one["log_digest"], again["log_digest"]);
}
