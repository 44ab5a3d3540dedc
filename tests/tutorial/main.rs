//! The commands of the tutorial, word by word as the page states them: on the shipped machine with long rope cylinders,
//! and, with `--ignored`, on the shipped machine itself with the numbers of the page.
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

/// Follows the page in a folder, except for the commands that `leaves_out` names; returns the folder.
fn follow(leaves_out: &[&str], change: impl FnOnce(&str) -> String) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("cases/cyjs10-5-37hb");
    copy(&root().join("cases/cyjs10-5-37hb"), &case);
    let file = case.join("case.toml");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, change(&text)).unwrap();
    let (commands, others) = commands(&page());
    // one builds, two install, one needs other machines
    assert_eq!((commands.len(), others), (6, 4), "{commands:?}");
    let is_left_out = |command: &String| leaves_out.iter().any(|it| command.starts_with(it));
    for command in commands.iter().filter(|command| !is_left_out(command)) {
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

/// Follows the page on the shipped machine with cylinders of six times the length and a budget that ends the diagnosis after
/// its first effect. `identify`, which would take as long as all others together, is followed on the oscillator by its
/// `tutorial.rs`, and here by the test on the shipped machine.
#[test]
fn every_command_of_the_page_can_be_typed_after_the_other() {
    let folder = follow(&["identify "], |case| {
        let mut case = format!("{case}\n[diagnose]\nsimulations = 1200\n");
        for (from, to) in [
            ("cylinder_length_m = 0.050 ", "cylinder_length_m = 0.300 "),
            ("back_cylinders = 72", "back_cylinders = 12"),
            ("front_cylinders = 114", "front_cylinders = 19"),
        ] {
            assert!(case.contains(from), "{from}");
            case = case.replacen(from, to, 1);
        }
        case
    });
    // every run has the folder that the page names
    for run in ["quick", "diagnose"] {
        result(folder.path(), &format!("cyjs10-5-37hb-{run}-seed1"));
    }
}

/// Returns the number on the page between two texts; commas between thousands are left out.
fn stated(page: &str, before: &str, after: &str) -> f64 {
    let rest = page.split_once(before).map(|(_, rest)| rest);
    let number = rest.and_then(|rest| Some(rest.split_once(after)?.0));
    assert!(
        number.is_some(),
        "the page does not state `{before}NUMBER{after}`"
    );
    number.unwrap().replace(',', "").parse().unwrap()
}

/// Follows the page on the shipped machine, which takes about ten minutes: `cargo test --release -p tests --test
/// tutorial -- --ignored`. Processors of another family compute other bits, and end within a hundredth.
#[test]
#[ignore = "takes about ten minutes"]
fn the_numbers_of_the_page_are_those_that_come_out() {
    let folder = follow(&[], str::to_owned);
    let page = page();
    let agrees = |before: &str, after: &str, found: f64, within: f64| {
        let stated = stated(&page, before, after);
        let apart = (found / stated - 1.0).abs();
        assert!(
            apart <= within,
            "{before}{stated}{after}: {found} comes out"
        );
    };
    let calibrated = result(folder.path(), "cyjs10-5-37hb-quick-seed1");
    let objective = |which: &str| calibrated["objective"][which].as_f64().unwrap();
    agrees(
        "MSE(1) + MSE(3) from ",
        " to ",
        objective("recommended"),
        0.01,
    );
    agrees("from 6.39 to ", " MPa²", objective("optimised"), 0.01);
    let lost = |condition: &str| {
        let machine = calibrated["machine"].as_array().unwrap();
        let mut machine = machine.iter().filter(|own| own["condition"] == condition);
        let stroke = machine.find(|own| own["quantity"] == "stroke").unwrap();
        let [measured, fit] = ["measured", "after"].map(|key| stroke[key].as_f64().unwrap());
        100.0 * (1.0 - fit / measured)
    };
    agrees("has lost ", " % of the measured stroke", lost("5rpm"), 0.05);
    agrees(
        "of the measured stroke (",
        " % at 4 rpm)",
        lost("4rpm"),
        0.05,
    );
    let diagnosed = result(folder.path(), "cyjs10-5-37hb-diagnose-seed1");
    assert_eq!(diagnosed["verdict"], "named");
    let effect = &diagnosed["effects"][0];
    let id = effect["id"].as_str().unwrap();
    assert!(page.contains(&format!("NAMED: `{id}`")), "{id}");
    let size = &effect["parameters"]["force"];
    let [low, high] = [0, 1].map(|end| size["ci95"][end].as_f64().unwrap());
    agrees(
        "a friction force of ",
        " N between",
        size["value"].as_f64().unwrap(),
        0.01,
    );
    agrees("95 % interval ", " to ", low, 0.01);
    let low_end = page.split_once("95 % interval ").unwrap().1;
    let high_end = stated(low_end, " to ", " N,");
    assert!(
        (high / high_end - 1.0).abs() < 0.01,
        "{high_end}: {high} comes out"
    );
}

#[test]
fn commands_are_found_with_those_that_are_left_out() {
    let page = "# T\n\n    cargo build && target/release/horsehead calibrate X\n\ntext `horsehead report Z`\n\n    \
                horsehead verify Y --condition Z\n    horsehead calibrate X --ssh a,b\n    cargo install x\n";
    let (own, others) = commands(page);
    assert_eq!(own, ["calibrate X", "verify Y --condition Z"]);
    assert_eq!(others, 3);
    let force = stated("a friction of 1,207 N.", "friction of ", " N");
    assert!((force - 1207.0).abs() < 1e-9, "{force}");
}
