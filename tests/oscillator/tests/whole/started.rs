//! Tests of calibrations that start from a table of individuals, and of start points given to `ask-tell` over
//! standard input.
use crate::{
    foreign_terms,
    rig::{Rig, number},
};
use serde_json::json;
use std::{fs, time::Duration};

const ROWS: &str = "mass,left,damping,lead\n2.13,5.6,26.0,1.7\n3.0,7.0,40.0,1.0\n";

#[test]
fn a_killed_calibration_from_a_table_goes_on_without_its_file() {
    let rig = Rig::new();
    let table = rig.path("table.csv");
    fs::write(rig.file("table.csv"), ROWS).unwrap();
    let (whole, killed) = (rig.path("whole"), rig.path("killed"));
    let alone = |run: &str| {
        let set = "population=40,evaluations=900";
        let words = [
            "calibrate",
            "CASE",
            "--run",
            run,
            "--preset",
            "l-shade",
            "--set",
            set,
        ];
        words.map(str::to_owned).to_vec()
    };
    let begun = |run: &str| [alone(run), vec!["--start".to_owned(), table.clone()]].concat();
    let json = |words: &[String]| {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        rig.json(&words)
    };
    let object = json(&begun(&whole));
    // no worse than the first row, and both rows stand where populations begin
    let scored = rig.path("scored");
    let rows = rig.json(&[
        "sweep",
        &table,
        "--case",
        &rig.path("case"),
        "--run",
        &scored,
    ]);
    let first = number(&rows["individuals"][0]["objective"]);
    assert!(number(&object["objective"]["optimised"]) <= first);
    assert_eq!(
        object["evaluations"], 900,
        "two of the table, and two that it answered"
    );
    foreign_terms::check_folder(whole.as_ref());
    rig.kill_at(
        &begun(&killed),
        &rig.file("killed"),
        20_000,
        Duration::from_secs(30),
    );
    assert!(
        !rig.file("killed/result.json").exists(),
        "it was killed too late"
    );
    fs::remove_file(&table).unwrap();
    assert_eq!(json(&alone(&killed))["log_digest"], object["log_digest"]);
    // other rows are another run
    fs::write(&table, ROWS.replace("40.0", "41.0")).unwrap();
    let words = begun(&killed);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let error = rig.refused(&words);
    assert!(error.contains("begins with other individuals"), "{error}");
}

#[test]
fn tables_that_no_search_can_begin_with_are_refused() {
    let rig = Rig::new();
    let (table, run) = (rig.path("table.csv"), rig.path("run"));
    let set = ["--preset", "random", "--set", "points=1"];
    let refused = |text: &str, said: &str| {
        fs::write(rig.file("table.csv"), text).unwrap();
        let words = ["calibrate", "CASE", "--run", &run, "--start", &table];
        let error = rig.refused(&[&words[..], &set].concat());
        assert!(
            error.contains("table.csv") && error.contains(said),
            "{error}"
        );
        assert!(!rig.file("run").exists(), "nothing is begun");
    };
    refused(
        ROWS,
        "individuals to start with is 2, but must be at most 1",
    );
    refused(&ROWS.replace("left", "elft"), "column `left` is missing");
    refused(&ROWS.replace("2.13", "9e9"), "allowed: 5e-1 to 8e0 kg");
    refused("mass,left,damping,lead\n", "no rows");
}

#[test]
fn a_talk_begins_with_points() {
    let rig = Rig::new();
    let opening = |start: serde_json::Value| {
        let x = json!({"name": "x", "lower": -1, "upper": 1});
        json!({"space": [x], "budget": 9, "start": start}).to_string() + "\n"
    };
    let two = opening(json!([[0.5], [-0.25]]));
    let told = json!({"tell": [{"id": 1, "f": 1.0}, {"id": 0, "f": 2.0}]});
    let (lines, code) = rig.run_with_input(&["ask-tell", "cma-es"], &format!("{two}{told}\n"));
    let first = json!([{"id": 0, "x": [0.5]}, {"id": 1, "x": [-0.25]}]);
    assert_eq!((&lines[0]["ask"], code), (&first, Some(0)));
    assert_eq!(lines[1]["ask"][0]["id"], 2);
    assert_eq!(lines[2]["best"]["x"], json!([-0.25]));
    for (start, said) in [
        (json!([[0.5, 1.0]]), "point 1 has 2 numbers, the space 1"),
        (
            json!([[0.5], [3.0]]),
            "point 2 has x = 3e0, outside -1e0 to 1e0",
        ),
    ] {
        let (lines, code) = rig.run_with_input(&["ask-tell", "cma-es"], &opening(start));
        assert_eq!(code, Some(2));
        assert!(
            lines[0]["error"].as_str().unwrap().contains(said),
            "{lines:?}"
        );
    }
}
