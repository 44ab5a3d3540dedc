//! Tests of the whole program on a model of another kind: real processes, a case in the general form, and no
//! pumping-unit terms in anything printed or written.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of tests: a command that cannot be run or read has failed"
)]
mod conditions;
mod evaluate;
mod finished;
mod foreign_terms;
mod identify;
mod orthogonal;
mod rates;
mod rig;
mod scaling;
mod started;
mod swept;
mod tutorial;

use oscillator::case_folder::{CROSSTALK, HIDDEN, NOISE_MM};
use rig::{Rig, number};
use search::strategy::CATALOGUE;
use serde_json::Value;
use std::{fs, time::Duration};

/// Settings with which a search preset ends within a second, for each preset that needs them.
const SHORT: &[(&str, &[&str])] = &[
    ("paper", &["population=24", "generations=12"]),
    ("paper-batch", &["population=24", "generations=12"]),
    ("window", &["population=24", "generations=12", "window=6"]),
    ("random", &["points=60"]),
    ("latin-hypercube", &["points=60"]),
    ("sobol", &["points=60"]),
    ("cma-es", &["evaluations=200"]),
    ("l-shade", &["evaluations=200"]),
];

/// Checks that each search preset improves the objective of a case with a model unknown to the program
/// (random sampling need only give a finite value).
#[test]
fn every_preset_calibrates() {
    let rig = Rig::new();
    for preset in CATALOGUE {
        let run = rig.path(preset.name);
        let set = SHORT.iter().find(|(name, _)| *name == preset.name);
        let set = set.map_or(&[][..], |(_, set)| *set);
        let mut words = vec!["calibrate", "CASE", "--run", &run, "--preset", preset.name];
        words.extend(set.iter().flat_map(|one| ["--set", *one]));
        let object = rig.json(&words);
        let objective = &object["objective"];
        let (before, after) = (
            number(&objective["recommended"]),
            number(&objective["optimised"]),
        );
        // points at random may all be worse than the start
        let better = after < before || (preset.strategy == "random" && after.is_finite());
        assert!(better, "{}: {objective}", preset.name);
        foreign_terms::check_folder(run.as_ref());
    }
}

/// Checks that the case is validated and simulated with its own units and abscissas.
#[test]
fn the_case_is_checked_and_simulated() {
    let rig = Rig::new();
    let text = rig.run(&["case", "check", "CASE"]);
    for said in ["always 1 of left", "known", "off", "measured in 8 cycles"] {
        assert!(text.contains(said), "{said}: {text}");
    }
    let object = rig.json(&["case", "check", "CASE"]);
    assert_eq!(object["unknowns"][0], "mass", "{object}");
    let simulate = ["simulate", "CASE", "--condition", "release"];
    let object = rig.json(&simulate);
    assert_eq!(object["verdict"], "complete", "{object}");
    assert_eq!(object["unknowns"]["mass"]["unit"], "kg", "{object}");
    let curve = &object["curves"]["displacement"];
    assert_eq!(
        (&curve["unit"], &curve["abscissa"]["unit"]),
        (&"mm".into(), &"s".into())
    );
    assert_eq!(curve["values"].as_array().unwrap().len(), 150);
    assert_eq!(rig.json(&simulate)["digest"], object["digest"]);
    let derived = rig.json(&[&simulate[..], &["--derivatives", "mass,left"]].concat());
    assert_eq!(derived["digest"], object["digest"]);
    for name in ["mass", "left"] {
        let missing = &derived["derivatives"][name]["missing"];
        assert_eq!(missing, "this model gives no derivatives", "{derived}");
    }
    rig.run(&[&simulate[..], &["--out", &rig.path("simulated")]].concat());
    foreign_terms::check_folder(&rig.file("simulated"));
}

/// Checks verification, report and export of a calibration.
#[test]
fn a_run_is_verified_reported_and_exported() {
    let rig = Rig::new();
    let run = rig.path("run");
    let text = rig.run(&["calibrate", "CASE", "--run", &run]);
    assert!(text.contains("mass") && text.contains("N/mm"), "{text}");
    for condition in ["steady_7hz", "release"] {
        let object = rig.json(&["verify", &run, "--condition", condition]);
        for (channel, unit) in [("displacement", "mm"), ("force", "N")] {
            let score = &object["channels"][channel]["optimised"];
            assert_eq!(score["unit"], unit, "{object}");
        }
        rig.run(&["verify", &run, "--condition", condition]);
    }
    fs::remove_file(rig.file("run/report.html")).unwrap();
    rig.run(&["report", &run]);
    let report = fs::read_to_string(rig.file("run/report.html")).unwrap();
    assert!(report.contains("displacement of the carriage") && report.contains("N/mm"));
    for format in ["csv", "sqlite", "parquet"] {
        rig.run(&["export", &run, "--format", format]);
    }
    let scores = fs::read_to_string(rig.file("run/csv/scores.csv")).unwrap();
    assert!(scores.contains("displacement,mm"), "{scores}");
    foreign_terms::check_folder(run.as_ref());
}

/// Checks that tied unknowns stay equal, and that fixed and absent unknowns keep their values.
#[test]
fn ties_fixed_and_absent_unknowns_keep_their_values() {
    let rig = Rig::new();
    let object = rig.json(&["calibrate", "CASE", "--run", &rig.path("run")]);
    let value = |name: &str| number(&object["unknowns"][name]["value"]);
    assert_eq!(value("left").to_bits(), value("right").to_bits());
    assert_eq!(value("armature").to_bits(), 0.4_f64.to_bits());
    assert_eq!(value("crosstalk").to_bits(), 0.0_f64.to_bits());
    assert!((value("mass") / HIDDEN.mass_kg - 1.0).abs() < 0.1);
}

/// Checks that the diagnosis names the hidden friction among five candidate effects and adds it to the case,
/// and that a calibration with it reaches the noise.
#[test]
fn the_hidden_effect_is_named_and_added() {
    let rig = Rig::new();
    let run = rig.path("diagnosis");
    let object = rig.json(&["diagnose", "CASE", "--run", &run, "--add"]);
    assert_eq!(object["verdict"], "named", "{object}");
    let added: Vec<&Value> = object["effects"].as_array().unwrap().iter().collect();
    assert_eq!(added.len(), 1, "{object}");
    assert_eq!(added[0]["id"], "dry_friction");
    let case = fs::read_to_string(rig.file("case/case.toml")).unwrap();
    assert!(case.contains("id = \"dry_friction\""), "{case}");
    foreign_terms::check_folder(run.as_ref());
    // the case has it now, and the command shows the run that found it
    let again = rig.json(&["diagnose", "CASE", "--run", &run, "--add"]);
    assert_eq!(again["effects"], object["effects"]);
    let unchanged = fs::read_to_string(rig.file("case/case.toml")).unwrap();
    assert_eq!(unchanged, case);
    // as the command itself advises: from what was found
    let (found, after) = (rig.path("diagnosis/calibrated.toml"), rig.path("after"));
    let from = ["--genes", &found, "--preset", "least-squares"];
    let object = rig.json(&[&["calibrate", "CASE", "--run", &after][..], &from].concat());
    let mse = number(&object["channels"]["displacement"]["optimised"]["mse"]);
    assert!(mse < 2.0 * NOISE_MM * NOISE_MM, "{mse}");
}

/// Checks that an unknown that is absent at its start value is a candidate, too, and that its estimate
/// becomes the new start value.
#[test]
fn a_hidden_unknown_is_named_and_becomes_the_start() {
    let rig = Rig::with_crosstalk();
    let run = rig.path("diagnosis");
    let object = rig.json(&["diagnose", "CASE", "--run", &run, "--add"]);
    // a slow force sensor explains the fitted record as well; what it predicts of the others is wrong
    assert_eq!(object["verdict"], "named", "{object}");
    assert_eq!(object["effects"][0]["id"], "crosstalk", "{object}");
    let case: toml::Table = fs::read_to_string(rig.file("case/case.toml"))
        .unwrap()
        .parse()
        .unwrap();
    let unknowns = case["unknowns"].as_array().unwrap();
    let found = unknowns
        .iter()
        .find(|one| one["name"].as_str() == Some("crosstalk"))
        .unwrap();
    let start = found["start"].as_float().unwrap();
    assert!((start / CROSSTALK - 1.0).abs() < 0.1, "{start}");
    foreign_terms::check_folder(run.as_ref());
}

/// Checks that a calibration that was killed and resumed gives the same log digest as an uninterrupted one.
#[test]
fn a_killed_calibration_goes_on() {
    let rig = Rig::new();
    let settings = ["--preset", "paper", "--set", "population=40,generations=12"];
    let command = |run: &str| {
        let words = ["calibrate", "CASE", "--run", run];
        [&words[..], &settings]
            .concat()
            .into_iter()
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let (whole, killed) = (rig.path("whole"), rig.path("killed"));
    let digest = |run: &str| {
        let words = command(run);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        rig.json(&words)["log_digest"].clone()
    };
    let expected = digest(&whole);
    rig.kill_at(
        &command(&killed),
        &rig.file("killed"),
        20_000,
        Duration::from_secs(30),
    );
    assert!(
        !rig.file("killed/result.json").exists(),
        "it was killed too late"
    );
    assert_eq!(digest(&killed), expected);
}
