//! The commands that start peers in another process: many sessions, and connections that say nothing.
use serde_json::Value;
use std::process::Command;

fn json(words: &str) -> Value {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bench"));
    let output = command
        .args(words.split(' '))
        .output()
        .expect("the program runs");
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    serde_json::from_slice(&output.stdout).expect("an object")
}

/// Checks that connections that send nothing are held, opened again where the coordinator closes them, and that the rate
/// beside them is measured.
#[test]
fn rates_are_measured_beside_silent_connections() {
    let words = "dispatch --connections 4 --jobs 200 --silent 300 --turns 1 --output json";
    let object = json(words);
    assert_eq!(object["workers"], 4);
    let silent = &object["silent"];
    assert_eq!(silent["connections"], 300);
    let number = |key: &str| silent[key].as_f64().unwrap();
    assert!(number("held") > 0.0, "{silent}");
    // a block lasts longer than silence is borne with
    assert!(number("reopened") >= 300.0, "{silent}");
    for key in [
        "jobs_per_s_without",
        "jobs_per_s_beside",
        "rate_ratio",
        "cpu_ratio",
    ] {
        assert!(number(key) > 0.0, "{silent}");
    }
}

#[test]
fn sessions_within_the_process_need_no_transport() {
    let object = json("dispatch --sessions 4 --jobs 400 --result-bytes 300 --output json");
    assert_eq!(
        (&object["workers"], &object["jobs"]),
        (&4.into(), &400.into())
    );
    assert!(object["jobs_per_s"].as_f64().unwrap() > 0.0, "{object}");
    assert!(object["silent"].is_null());
}
