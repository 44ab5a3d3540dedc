//! Tests that compare results for three imported PEST models with those of PEST++.
use crate::rig::{Rig, source};
use serde_json::Value;
use std::fs;

/// Returns the stored results of PEST++ for a model.
fn found(model: &str) -> Value {
    let text = fs::read_to_string(source("pest").join("pestpp.json")).unwrap();
    serde_json::from_str::<Value>(&text).unwrap()[model].take()
}

/// Imports a PEST model as a case and adds its program to the allowed ones.
fn imported(model: &str) -> Rig {
    let rig = Rig::new();
    let control = source("pest").join(model).join("model.pst");
    let made = rig.object(&["case", "import", control.to_str().unwrap(), "case"]);
    let expected = if model == "tanks" { 2 } else { 1 };
    assert_eq!(made["notes"].as_array().unwrap().len(), expected, "{made}");
    rig.done(&["allow", "case"]);
    rig
}

/// Converts a parameter value to the space in which PEST++ estimates it: log10, except for the parameter
/// `floor` of the model `decay`, which is not transformed.
fn counted(model: &str, name: &str, value: f64) -> f64 {
    if (model, name) == ("decay", "floor") {
        value
    } else {
        value.log10()
    }
}

/// Calibrates an imported model and checks it against PEST++: parameters within a hundredth of its standard
/// deviations, objective to four digits, and at most half as many model runs.
fn calibrated(model: &str) {
    let (rig, expected) = (imported(model), found(model));
    let result = rig.object(&["calibrate", "case", "--preset", "descent", "--run", "run"]);
    let runs = result["evaluations"].as_u64().unwrap();
    assert!(
        2 * runs <= expected["runs"].as_u64().unwrap(),
        "{model}: {runs} runs"
    );
    let phi = result["objective"]["optimised"].as_f64().unwrap();
    let least = expected["phi"]
        .as_array()
        .unwrap()
        .last()
        .unwrap()
        .as_f64()
        .unwrap();
    assert!(
        (phi / least - 1.0).abs() < 5e-5,
        "{model}: {phi} and {least}"
    );
    for (name, own) in expected["in_estimation_space"].as_object().unwrap() {
        let value = result["unknowns"][name]["value"].as_f64().unwrap();
        let theirs = expected["parameters"][name].as_f64().unwrap();
        let off = counted(model, name, value) - counted(model, name, theirs);
        let sd = own["sd"].as_f64().unwrap();
        assert!(
            (off / sd).abs() < 0.01,
            "{model}: {name} is off by {} sd",
            off / sd
        );
    }
    for file in ["calibrated.par", "residuals.rei"] {
        let text = fs::read_to_string(rig.file("run").join(file)).unwrap();
        assert!(text.lines().count() > 3, "{text}");
    }
    assert_eq!(rig.left(), Vec::<String>::new());
}

#[test]
fn parameters_and_objective_are_those_of_pest() {
    calibrated("cantilever");
}

#[test]
#[ignore = "starts Python some thousand times"]
fn parameters_and_objective_of_other_models_are_those_of_pest() {
    for model in ["decay", "tanks"] {
        calibrated(model);
    }
}

/// Checks the intervals of a calibration against the standard deviations that pyemu computed from the run's own files:
/// `pyemu/schur.py` wrote them, and compares again in `.ci/run`.
#[test]
fn deviations_are_those_of_pyemu() {
    let rig = imported("decay");
    let result = rig.object(&["calibrate", "case", "--preset", "descent", "--run", "run"]);
    let text = fs::read_to_string(source("external/pyemu/decay.json")).unwrap();
    let expected: Value = serde_json::from_str(&text).unwrap();
    for (name, sd) in expected.as_object().unwrap() {
        let [low, high] = [0, 1].map(|end| result["unknowns"][name]["ci95"][end].as_f64().unwrap());
        let half = 0.5 * (counted("decay", name, high) - counted("decay", name, low));
        let ratio = half / NORMAL / sd.as_f64().unwrap();
        assert!((ratio - 1.0).abs() < 0.01, "{name} {ratio}");
    }
    let file = fs::read(rig.file("run/jacobian.jco")).unwrap();
    // three parameters, 25 observations, each of 12 and 20 characters
    assert_eq!(
        file[..8],
        [(-3_i32).to_le_bytes(), (-25_i32).to_le_bytes()].concat()
    );
    assert!(file.ends_with(b"y24                 "));
}

/// Half width of a 95 % interval of a normal distribution in standard deviations.
const NORMAL: f64 = 1.96;

#[test]
fn uncertainties_are_those_of_pest() {
    uncertain("cantilever");
}

#[test]
#[ignore = "starts Python some hundred times"]
fn uncertainties_of_another_model_are_those_of_pest() {
    uncertain("tanks");
}

/// Checks that standard deviations of parameters and predictions agree with those of PEST++ within a tenth.
/// PEST++ computes its prediction uncertainties after lowering the weights of large residuals; Horsehead does
/// not lower weights.
fn uncertain(model: &str) {
    let (rig, expected) = (imported(model), found(model));
    let result = rig.object(&["identify", "case", "--run", "run"]);
    assert_eq!(result["diagnose_first"], false, "{model}");
    for (name, own) in expected["in_estimation_space"].as_object().unwrap() {
        let [low, high] = [0, 1].map(|end| result["unknowns"][name]["ci95"][end].as_f64().unwrap());
        let half = 0.5 * (counted(model, name, high) - counted(model, name, low));
        let ratio = half / NORMAL / own["sd"].as_f64().unwrap();
        assert!((ratio - 1.0).abs() < 0.1, "{model}: {name} {ratio}");
    }
    let channel = if model == "tanks" {
        "predictions"
    } else {
        "unseen"
    };
    let band = &result["prediction"]["model"][channel];
    for (at, (name, own)) in expected["predictions"]
        .as_object()
        .unwrap()
        .iter()
        .enumerate()
    {
        let [low, high] = ["low", "high"].map(|end| band[end][at].as_f64().unwrap());
        let ratio = 0.5 * (high - low) / NORMAL / own["sd"].as_f64().unwrap();
        assert!((ratio - 1.0).abs() < 0.1, "{model}: {name} {ratio}");
    }
}

/// Checks that an import that fails while reading the new case, because a template is missing or misnames a
/// parameter, removes the case folder so that the import can be repeated.
#[test]
fn an_import_that_fails_after_writing_can_be_tried_again() {
    let rig = Rig::new();
    let folder = rig.file("model");
    fs::create_dir(&folder).unwrap();
    for entry in source("pest/decay").read_dir().unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
    }
    let template = folder.join("model.tpl");
    let text = fs::read_to_string(&template).unwrap();
    let import = ["case", "import", "model/model.pst", "case"];
    for (broken, said) in [
        (None, "model.tpl: no such file"),
        (
            Some(text.replace("floor  ", "flor   ")),
            "did you mean `floor`?",
        ),
    ] {
        match broken {
            None => fs::remove_file(&template).unwrap(),
            Some(broken) => fs::write(&template, broken).unwrap(),
        }
        let errors = rig.refused(&import);
        assert!(errors.contains(said), "{errors}");
        assert!(errors.contains("case was removed again"), "{errors}");
        assert!(!rig.file("case").exists());
        fs::write(&template, &text).unwrap();
    }
    rig.done(&import);
}

#[test]
fn what_is_there_is_not_written_over_and_what_cannot_be_read_is_said() {
    let rig = Rig::new();
    let control = source("pest/decay/model.pst");
    let control = control.to_str().unwrap();
    fs::create_dir(rig.file("case")).unwrap();
    let said = rig.refused(&["case", "import", control, "case"]);
    assert!(said.contains("exists already"), "{said}");
    let text = fs::read_to_string(control).unwrap();
    fs::write(rig.file("bad.pst"), text.replace("y03 9.106215", "y03 9,1")).unwrap();
    let said = rig.refused(&["case", "import", "bad.pst"]);
    assert!(
        said.contains("line 23") && said.contains("obsval"),
        "{said}"
    );
    assert!(!rig.file("bad").exists());
    let said = rig.refused(&["case", "import", "nowhere.pst"]);
    assert!(said.contains("nowhere.pst"), "{said}");
}
