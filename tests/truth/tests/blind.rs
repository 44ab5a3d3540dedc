//! The whole way on a coarse machine: records are made and sealed, diagnosed by the program, and opened.
//!
//! Ropes of 150 mm cylinders against a truth of 75 mm ones, and four times the noise of the full suite,
//! which hides what that difference leaves. To take seconds, the diagnosis starts from Table 3's
//! coefficients and considers a part of the library; the suite itself (README.md) does neither. The
//! programs are those that `cargo test --workspace` built.
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

fn truth(arguments: &[&str]) -> String {
    run(Command::new(env!("CARGO_BIN_EXE_truth")).args(arguments))
}

fn run(command: &mut Command) -> String {
    let out = command
        .stderr(Stdio::inherit())
        .output()
        .expect("it starts");
    assert!(out.status.success(), "{command:?} fails");
    String::from_utf8(out.stdout).expect("text")
}

/// The judged program, with its worker beside it.
fn horsehead() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_BIN_EXE_truth"));
    for (name, package) in [("horsehead", "coordinator"), ("horsehead-worker", "worker")] {
        if !folder.with_file_name(name).is_file() {
            run(Command::new(env!("CARGO")).args(["build", "-p", package, "--bin", name]));
        }
    }
    folder.with_file_name("horsehead")
}

/// The shipped case with fewer, longer cylinders.
fn coarse_case(folder: &Path) -> PathBuf {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb");
    let case = folder.join("case");
    for part in ["back_head", "measured"] {
        fs::create_dir_all(case.join(part)).expect("a folder");
        for file in fs::read_dir(shipped.join(part)).expect("the shipped case") {
            let file = file.expect("an entry");
            let to = case.join(part).join(file.file_name());
            fs::copy(file.path(), to).expect("a copy");
        }
    }
    let mut text = fs::read_to_string(shipped.join("case.toml")).expect("the case file");
    for (key, fine, coarse) in [
        ("cylinder_length_m", "0.050", "0.150"),
        ("back_cylinders", "72", "24"),
        ("front_cylinders", "114", "38"),
    ] {
        let (from, to) = (format!("{key} = {fine}"), format!("{key} = {coarse}"));
        assert_eq!(text.matches(&from).count(), 1, "{from}");
        text = text.replace(&from, &to);
    }
    fs::write(case.join("case.toml"), text).expect("the case file");
    case
}

/// Where a calibration of the machine ended before: the optimised column of the paper's Table 3, with the
/// axial damping of a steel rope.
const START: &str = r#"
kb1  = { value = 7.81e8, unit = "N/m" }
kb23 = { value = 2.26e8, unit = "N/m" }
kb4  = { value = 204.0, unit = "N.m/deg" }
kb56 = { value = 308.0, unit = "N.m/deg" }
cb1  = { value = 1.0e6, unit = "N.s/m" }
cb23 = { value = 4287.0, unit = "N.s/m" }
cb4  = { value = 45.0, unit = "N.m.s/deg" }
cb56 = { value = 56.0, unit = "N.m.s/deg" }
kc   = { value = 4.01e8, unit = "N/m^1.5" }
cc   = { value = 1.02e3, unit = "N.s/m" }
"#;

/// Effects that are not considered. Those that are: pivot friction, what looks like it, and others of
/// load, crank and gauges.
const WITHOUT: &str = "load_cell_lag,load_cell_gain,card_smoothing,valve_leakage,gas_interference,\
fluid_pound,stuffing_box_friction,rod_string_reaction,front_head_radius,front_rope_bending_loss,\
beam_inertia,post_compliance,head_profile_wear,head_damping,rope_stretch,rope_toe,rope_hysteresis,\
counterweight_phase,crank_angle_offset,pin_clearance,twin_rope_inequality,gauge_cross_talk,gauge_gain,\
amplifier_lag";

/// Makes one set, diagnoses it, opens the answer: the verdict's words and the table.
fn trial(arguments: &[&str]) -> (serde_json::Value, String) {
    let scratch = tempfile::tempdir().expect("a folder");
    let at = |name: &str| scratch.path().join(name).display().to_string();
    let case = coarse_case(scratch.path());
    let case = case.display().to_string();
    let (sets, answers, verdicts) = (at("sets"), at("answers.json"), at("verdicts"));
    let make = [
        "make",
        "--case",
        &case,
        "--out",
        &sets,
        "--answers",
        &answers,
        "--coarse",
    ];
    let said = truth(&[&make, arguments].concat());
    let set = PathBuf::from(said.lines().next().expect("a folder's name"));
    let commitment = said.split_whitespace().last().expect("a commitment");
    let name = set
        .file_name()
        .and_then(|name| name.to_str())
        .expect("a name");

    let (runs, start) = (at("run"), at("start.toml"));
    fs::write(&start, START).expect("a file");
    let mut diagnose = Command::new(horsehead());
    diagnose
        .args(["diagnose", &case, "--measured"])
        .arg(&set)
        .args(["--run", &runs, "--rounds", "1", "--output", "json"])
        .args(["--genes", &start, "--without", WITHOUT])
        .current_dir(scratch.path());
    let verdict = run(&mut diagnose);
    fs::create_dir(&verdicts).expect("a folder");
    fs::write(Path::new(&verdicts).join(format!("{name}.json")), &verdict).expect("a file");

    let open = ["open", "--answers", &answers, "--verdicts", &verdicts];
    let table = truth(&[&open[..], &["--commitment", commitment]].concat());
    // whoever changes the answers afterwards is found out
    let sealed = fs::read_to_string(&answers).expect("answers");
    fs::write(&answers, sealed.replace("\"seed\"", " \"seed\"")).expect("a file");
    let forged = Command::new(env!("CARGO_BIN_EXE_truth"))
        .args(open)
        .args(["--commitment", commitment])
        .output()
        .expect("it starts");
    assert!(!forged.status.success());
    (serde_json::from_str(&verdict).expect("a verdict"), table)
}

#[test]
fn a_strong_friction_is_named() {
    let (verdict, table) = trial(&[
        "--seed",
        "2",
        "--stratum",
        "single",
        "--effect",
        "pivot_friction",
        "--times",
        "5",
        "--noise",
        "4",
    ]);
    eprintln!("{table}");
    let named = &verdict["effects"][0];
    assert_eq!(verdict["verdict"], "named", "{verdict}");
    assert_eq!(named["id"], "pivot_friction");
    assert!(table.contains("| single, all: first name right |  | 1/1 = 100 %"));
    assert!(table.contains("| false names of all names | <= 10 % | 0/1 = 0 %"));
}

#[test]
fn nothing_is_named_where_nothing_is() {
    let (verdict, table) = trial(&["--seed", "2", "--stratum", "zero", "--noise", "4"]);
    eprintln!("{table}");
    assert_eq!(verdict["verdict"], "nothing_detected", "{verdict}");
    assert!(table.contains("| zero: any claim | <= 5 % | 0/1 = 0 %"));
}
