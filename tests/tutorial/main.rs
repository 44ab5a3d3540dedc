//! The commands of the tutorial, word by word as the page states them: on the shipped machine with long rope cylinders,
//! and, where asked for, on the shipped machine itself with the numbers of the page.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of a test suite: to panic is to fail the test"
)]
use serde_json::Value;
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};
use tests::process::{coordinator_program, worker_program};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn page() -> String {
    fs::read_to_string(root().join("docs/tutorial.md")).unwrap()
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let to = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &to);
        } else {
            fs::copy(entry.path(), to).unwrap();
        }
    }
}

/// Returns the commands of the page that a reader types on one machine, without the folder of the program, and the
/// number of those that build or need other machines.
fn commands(page: &str) -> (Vec<String>, usize) {
    let blocks = page.lines().filter_map(|line| line.strip_prefix("    "));
    let all: Vec<&str> = blocks.flat_map(|line| line.split(" && ")).collect();
    let own = all.iter().filter(|command| !command.contains("--ssh"));
    let own = own.filter_map(|command| {
        let command = command.strip_prefix("target/release/").unwrap_or(command);
        command.strip_prefix("horsehead ").map(str::to_owned)
    });
    let own: Vec<String> = own.collect();
    let others = all.len() - own.len();
    (own, others)
}

/// Follows the page in a folder; returns the folder.
fn follow(change: impl FnOnce(&str) -> String) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("cases/cyjs10-5-37hb");
    copy(&root().join("cases/cyjs10-5-37hb"), &case);
    let file = case.join("case.toml");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, change(&text)).unwrap();
    let (commands, others) = commands(&page());
    // one builds, two install, one needs other machines
    assert_eq!((commands.len(), others), (6, 4), "{commands:?}");
    for command in commands {
        let output = Command::new(coordinator_program())
            .args(command.split_whitespace())
            .env("HORSEHEAD_WORKER", worker_program())
            .current_dir(folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{command}: {said}");
    }
    folder
}

fn result(folder: &Path, run: &str) -> Value {
    let text = fs::read(folder.join("runs").join(run).join("result.json")).unwrap();
    serde_json::from_slice(&text).unwrap()
}

/// Follows the page on the shipped machine with cylinders of three times the length.
#[test]
fn every_command_of_the_page_can_be_typed_after_the_other() {
    let folder = follow(|case| {
        let mut case = case.to_owned();
        for (from, to) in [
            ("cylinder_length_m = 0.050 ", "cylinder_length_m = 0.150 "),
            ("back_cylinders = 72", "back_cylinders = 24"),
            ("front_cylinders = 114", "front_cylinders = 38"),
        ] {
            assert!(case.contains(from), "{from}");
            case = case.replacen(from, to, 1);
        }
        case
    });
    let diagnosed = result(folder.path(), "cyjs10-5-37hb-diagnose-seed1");
    assert_eq!(
        diagnosed["effects"][0]["id"], "stuffing_box_friction",
        "{diagnosed}"
    );
}

/// Formats a number as the page does, with commas between thousands.
fn with_commas(value: f64) -> String {
    let digits = format!("{value:.0}");
    let (thousands, rest) = digits.split_at(digits.len().saturating_sub(3));
    [thousands, rest].join(if thousands.is_empty() { "" } else { "," })
}

/// Follows the page on the shipped machine, which takes about ten minutes: `cargo test --release -p tests --test
/// tutorial -- --ignored`.
#[test]
#[ignore = "takes about ten minutes"]
fn the_numbers_of_the_page_are_those_that_come_out() {
    let folder = follow(str::to_owned);
    let page = page();
    let states = |what: &str| assert!(page.contains(what), "the page does not state: {what}");
    let calibrated = result(folder.path(), "cyjs10-5-37hb-quick-seed1");
    let [before, after] =
        ["recommended", "optimised"].map(|which| calibrated["objective"][which].as_f64().unwrap());
    states(&format!("from {before:.2} to {after:.3} MPa²"));
    for (condition, words) in [("5rpm", "of the measured stroke"), ("4rpm", "at 4 rpm)")] {
        let machine = calibrated["machine"].as_array().unwrap();
        let stroke = machine
            .iter()
            .find(|own| own["quantity"] == "stroke" && own["condition"] == condition);
        let [measured, fit] =
            ["measured", "after"].map(|key| stroke.unwrap()[key].as_f64().unwrap());
        let lost = format!("{:.1}", 100.0 * (1.0 - fit / measured));
        states(&format!("{} % {words}", lost.trim_end_matches(".0")));
    }
    let diagnosed = result(folder.path(), "cyjs10-5-37hb-diagnose-seed1");
    assert_eq!(diagnosed["verdict"], "named");
    let effect = &diagnosed["effects"][0];
    states(&format!("NAMED: `{}`", effect["id"].as_str().unwrap()));
    let size = &effect["parameters"]["force"];
    let [low, high] = [0, 1].map(|end| size["ci95"][end].as_f64().unwrap());
    states(&format!(
        "a friction force of {} N",
        with_commas(size["value"].as_f64().unwrap())
    ));
    states(&format!(
        "interval {} to {} N",
        with_commas(low),
        with_commas(high)
    ));
}

#[test]
fn commands_are_found_with_those_that_are_left_out() {
    let page = "# T\n\n    cargo build && target/release/horsehead calibrate X\n\ntext `horsehead no`\n\n    \
                horsehead verify Y\n    horsehead calibrate X --ssh a,b\n    cargo install x\n";
    let (own, others) = commands(page);
    assert_eq!(own, ["calibrate X", "verify Y"]);
    assert_eq!(others, 3);
    assert_eq!([999.4, 1206.6].map(with_commas), ["999", "1,207"]);
}
