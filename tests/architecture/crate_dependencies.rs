//! Permitted dependencies between the crates of the workspace.
use crate::workspace::{dependencies, packages};
use std::collections::BTreeSet;

/// Permitted dependencies between the crates of the workspace: `(from, to)`.
const ARROWS: &[(&str, &str)] = &[
    ("link", "protocol"),
    ("worker", "protocol"),
    ("worker", "exchange"),
    ("worker", "link"),
    ("worker", "simulation"),
    ("search", "protocol"),
    ("discrepancy", "search"),
    ("discrepancy", "protocol"),
    ("discrepancy", "record"),
    ("record", "protocol"),
    ("record", "search"),
    // starting workers knows neither cases nor runs
    ("launch", "link"),
    ("launch", "protocol"),
    ("launch", "support"),
    // reading a case knows neither runs nor pictures
    ("case", "protocol"),
    ("case", "exchange"),
    ("case", "record"),
    ("case", "support"),
    // loops over whoever evaluates
    ("study", "protocol"),
    ("study", "dispatch"),
    ("study", "journal"),
    ("study", "search"),
    ("study", "discrepancy"),
    ("study", "record"),
    // its tests take the shipped case for an example
    ("study", "case"),
    // pages and tables: drawn from plain data, cases and journals' accounts
    ("report", "protocol"),
    ("report", "exchange"),
    ("report", "case"),
    ("report", "discrepancy"),
    ("report", "record"),
    ("report", "journal"),
    ("report", "study"),
    ("report", "support"),
    // values of coordinates of a search space
    ("report", "search"),
    ("store", "protocol"),
    ("store", "journal"),
    ("store", "case"),
    // runs of every kind: what they ask, who works on them, and what readers see
    ("run", "protocol"),
    ("run", "case"),
    ("run", "discrepancy"),
    ("run", "dispatch"),
    ("run", "journal"),
    ("run", "launch"),
    ("run", "link"),
    ("run", "report"),
    ("run", "search"),
    ("run", "store"),
    ("run", "study"),
    ("run", "support"),
    ("coordinator", "run"),
    // follows runs, and simulates individuals for their pages
    ("dashboard", "case"),
    ("dashboard", "discrepancy"),
    ("dashboard", "journal"),
    ("dashboard", "protocol"),
    ("dashboard", "report"),
    ("dashboard", "run"),
    ("dashboard", "study"),
    ("dashboard", "support"),
    ("coordinator", "dashboard"),
    ("coordinator", "store"),
    ("coordinator", "report"),
    ("coordinator", "study"),
    ("coordinator", "case"),
    ("coordinator", "launch"),
    // what a run asked, was answered and found, whoever asks
    ("journal", "protocol"),
    ("journal", "support"),
    ("coordinator", "journal"),
    // jobs and results, whatever they are about; strategies stand in for a study on a simulated clock
    ("dispatch", "journal"),
    ("dispatch", "link"),
    ("dispatch", "protocol"),
    ("dispatch", "search"),
    ("dispatch", "support"),
    ("coordinator", "dispatch"),
    ("coordinator", "support"),
    ("coordinator", "protocol"),
    ("coordinator", "exchange"),
    ("coordinator", "link"),
    ("coordinator", "search"),
    ("coordinator", "discrepancy"),
    ("coordinator", "record"),
    ("coordinator", "fatigue"),
    // the truth generator takes from everybody, and nobody from it
    ("truth", "protocol"),
    ("truth", "simulation"),
    ("truth", "worker"),
    ("truth", "case"),
    // its tests use a feature of its own
    ("simulation", "simulation"),
    // a model of the suites, which no program knows
    ("oscillator", "protocol"),
    ("oscillator", "search"),
    ("oscillator", "worker"),
    ("oscillator", "case"),
    ("oscillator", "journal"),
    ("oscillator", "discrepancy"),
    ("oscillator", "record"),
    // decisions of a diagnosis on linearised cases
    ("rejudge", "case"),
    ("rejudge", "discrepancy"),
    ("rejudge", "record"),
    ("rejudge", "protocol"),
    ("rejudge", "search"),
    ("rejudge", "worker"),
    ("rejudge", "oscillator"),
    // developers' measurements
    ("bench", "dispatch"),
    ("bench", "journal"),
    ("bench", "link"),
    ("bench", "simulation"),
    ("bench", "study"),
    ("bench", "support"),
    ("bench", "protocol"),
    ("bench", "worker"),
    ("bench", "case"),
    ("bench", "report"),
    ("bench", "search"),
];

/// External crates with heavy dependencies or side effects, each with the only workspace crates that may
/// depend on it.
const GATED: &[(&str, &[&str])] = &[
    ("zenoh", &["link", "tests"]),
    (
        "tokio",
        &[
            "link",
            "worker",
            "launch",
            "dispatch",
            "dashboard",
            "run",
            "study",
            "coordinator",
            "tests",
            "bench",
        ],
    ),
    (
        "anyhow",
        &[
            "worker",
            "study",
            "run",
            "dashboard",
            "coordinator",
            "tests",
            "truth",
            "bench",
            "rejudge",
        ],
    ),
    (
        "clap",
        &["worker", "coordinator", "truth", "bench", "rejudge"],
    ),
    (
        "nalgebra",
        &[
            "case",
            "simulation",
            "search",
            "record",
            "discrepancy",
            "oscillator",
        ],
    ),
    ("amd", &["simulation"]),
    ("faer", &["simulation"]),
    ("pulp", &["simulation"]),
    ("axum", &["dashboard"]),
    ("rusqlite", &["store"]),
    ("parquet", &["store"]),
];

#[test]
fn nobody_depends_on_the_truth() {
    let packages = packages();
    assert!(packages.iter().any(|p| p["name"] == "truth"));
    for package in &packages {
        let names = dependencies(package);
        let name = &package["name"];
        assert!(
            names.iter().all(|(to, _)| *to != "truth"),
            "{name} must not depend on truth"
        );
    }
}

#[test]
fn arrows_point_one_way() {
    let packages = packages();
    let ours: BTreeSet<&str> = packages
        .iter()
        .map(|p| p["name"].as_str().unwrap())
        .collect();
    for package in &packages {
        let from = package["name"].as_str().unwrap();
        // tests may build what the program itself must not
        for (to, in_tests) in dependencies(package) {
            if ours.contains(to) && from != "tests" {
                assert!(
                    ARROWS.contains(&(from, to)),
                    "{from} must not depend on {to}"
                );
            }
            if let Some((_, users)) = GATED.iter().find(|(name, _)| *name == to) {
                assert!(
                    in_tests || users.contains(&from),
                    "{from} must not use {to}"
                );
            }
        }
    }
}
