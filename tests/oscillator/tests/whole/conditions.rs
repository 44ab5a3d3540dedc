//! Test of an objective over two conditions with weights, from the case file to report, verification and diagnosis.
use crate::{
    foreign_terms,
    rig::{Rig, number},
};
use serde_json::Value;
use std::fs;

#[test]
fn two_conditions_are_calibrated_together_and_the_second_validates_a_diagnosis() {
    let rig = Rig::new();
    let file = rig.file("case/case.toml");
    let text = fs::read_to_string(&file).unwrap();
    let both = "condition = [\"steady_5hz\", { name = \"steady_7hz\", weight = 0.5 }]\nterms";
    let one = "condition = \"steady_5hz\"\nterms";
    assert!(text.contains(one));
    fs::write(&file, text.replace(one, both)).unwrap();
    let checked = rig.run(&["case", "check", "CASE"]);
    assert!(
        checked.contains("steady_5hz + 0.5 x steady_7hz"),
        "{checked}"
    );

    let run = rig.path("run");
    let calibrate = ["calibrate", "CASE", "--preset", "least-squares"];
    let object = rig.json(&[&calibrate[..], &["--run", &run]].concat());
    let digest = object["log_digest"].as_str().unwrap();
    let expected = ["recommended", "optimised"].map(|which| {
        let second = &object["other_conditions"]["steady_7hz"]["objective"][which];
        let first = &object["channels"];
        let own = |name: &str| number(&first[name][which]["mse"]);
        own("displacement") + 0.01 * own("force") + 0.5 * number(second)
    });
    for (which, expected) in ["recommended", "optimised"].iter().zip(expected) {
        let found = number(&object["objective"][which]);
        assert!(
            (found / expected - 1.0).abs() < 1e-9,
            "{which}: {found} {expected}"
        );
    }
    let said = "conditions steady_5hz and steady_7hz (weight 0.5)";
    let tables = fs::read_to_string(rig.file("run/tables.txt")).unwrap();
    assert!(tables.contains(said), "{tables}");
    let page = fs::read_to_string(rig.file("run/report.html")).unwrap();
    assert!(page.contains(said));
    let role = rig.run(&["verify", &run, "--condition", "steady_7hz"]);
    assert!(role.contains("one of the calibrated conditions"), "{role}");
    let role = rig.run(&["verify", &run, "--condition", "release"]);
    assert!(role.contains("which took no part in the fit"), "{role}");

    // on more slots than a descent has jobs, divided or not
    let wide = rig.path("wide");
    let words = [&calibrate[..], &["--run", &wide, "--workers", "12"]].concat();
    assert_eq!(rig.json(&words)["log_digest"], digest);

    let diagnosis = rig.path("diagnosis");
    let object = rig.json(&["diagnose", "CASE", "--run", &diagnosis]);
    assert_eq!(object["verdict"], "named", "{object}");
    let predicted = object["prediction"].as_array().unwrap();
    let validates = |own: &Value| own["record"] == "steady_7hz" && own["held_out"] == "condition";
    assert!(predicted.iter().any(validates), "{object}");
    foreign_terms::check_folder(run.as_ref());
}
