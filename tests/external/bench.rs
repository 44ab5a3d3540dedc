//! Tests with a Python model that has five candidate effects, one of which acts in the measured records but
//! is absent from the case.
use crate::rig::Rig;
use serde_json::Value;
use std::{fs, process::Command};

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

/// Checks that a validation that has used up its budget takes no name away: the verdict says that it is one in
/// part, and which stage ran out.
#[test]
fn a_name_stands_when_its_validation_has_used_up_its_budget() {
    let rig = Rig::of("bench");
    let make = rig.file("case/make.py");
    let measured = rig.file("two");
    let written = Command::new("python3")
        .args([
            make.as_os_str(),
            measured.as_os_str(),
            "friction=4".as_ref(),
        ])
        .status();
    assert!(written.unwrap().success());
    let file = rig.file("case/case.toml");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text + "\n[diagnose]\nsimulations = 1200\n").unwrap();
    let answer = rig.object(&["diagnose", "case", "--measured", "two", "--run", "run"]);
    assert_eq!(answer["verdict"], "named", "{answer}");
    let names = answer["effects"].as_array().unwrap().iter();
    let names: Vec<&Value> = names.map(|effect| &effect["id"]).collect();
    assert_eq!(names, ["friction", "hardening"], "{answer}");
    // comparisons of rivals used up the budget, and the validation ran all the same
    let ran_out = answer["ran_out"].as_array().unwrap();
    assert!(ran_out.contains(&Value::from("show")), "{answer}");
    assert_eq!(answer["in_part"], true, "{answer}");
    let reason = answer["reason"].as_str().unwrap();
    assert!(
        reason.contains("the stage \"show\" used up its budget"),
        "{reason}"
    );
    assert_eq!(
        answer["prediction"].as_array().unwrap().len(),
        2,
        "{answer}"
    );
}

/// Checks that a budget of zero is refused by file and field.
#[test]
fn a_budget_of_no_simulation_is_refused() {
    let rig = Rig::of("bench");
    let file = rig.file("case/case.toml");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text + "\n[diagnose]\nsimulations = 0\n").unwrap();
    let said = rig.refused(&["diagnose", "case", "--run", "run"]);
    assert!(
        said.contains("case.toml") && said.contains("simulations"),
        "{said}"
    );
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
