//! The whole way on a coarse machine: records are made and sealed, diagnosed by the program, and opened.
//!
//! Ropes of 150 mm cylinders against a truth of 75 mm ones, and four times the noise of the full suite,
//! which hides what that difference leaves. To take seconds, the diagnosis starts from Table 3's
//! coefficients and considers a part of the library; the suite itself (README.md) does neither. The
//! programs are those that `cargo test --workspace` built.
mod again;
mod coarse;

use coarse::{FRICTION, Trial, WITHOUT, run, truth};
use std::{fs, process::Command};

/// Makes one set, diagnoses it, opens the answer: the verdict's words and the table.
fn trial(arguments: &[&str]) -> (serde_json::Value, String) {
    let trial = Trial::make(arguments);
    let verdict = run(&mut trial.diagnose(WITHOUT));
    let verdicts = trial.at("verdicts");
    fs::create_dir(&verdicts).expect("a folder");
    let name = trial.set.file_name().expect("a name").display();
    fs::write(verdicts.join(format!("{name}.json")), &verdict).expect("a file");

    let (answers, verdicts) = (trial.at("answers.json"), verdicts.display().to_string());
    let answers = answers.display().to_string();
    let open = ["open", "--answers", &answers, "--verdicts", &verdicts];
    let table = truth(&[&open[..], &["--commitment", &trial.commitment]].concat());
    // whoever changes the answers afterwards is found out
    let sealed = fs::read_to_string(&answers).expect("answers");
    fs::write(&answers, sealed.replace("\"seed\"", " \"seed\"")).expect("a file");
    let forged = Command::new(env!("CARGO_BIN_EXE_truth"))
        .args(open)
        .args(["--commitment", &trial.commitment])
        .output()
        .expect("it starts");
    assert!(!forged.status.success());
    (serde_json::from_str(&verdict).expect("a verdict"), table)
}

#[test]
fn a_strong_friction_is_named() {
    let (verdict, table) = trial(&FRICTION);
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
