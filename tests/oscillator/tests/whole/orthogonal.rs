//! Tests of orthogonal sweeps: one that was killed and resumed gives the same bytes, and factors that cannot
//! be tested are refused before anything runs.
use crate::{
    foreign_terms,
    rig::{Rig, number},
};
use serde_json::{Value, json};
use std::{fs, time::Duration};

/// Returns the arguments of a small orthogonal sweep: nine rows of three factors, two seeds, sixty
/// evaluations each.
fn small(run: &str) -> Vec<&str> {
    vec![
        "sweep",
        "orthogonal",
        "CASE",
        "--run",
        run,
        "--evaluations",
        "60",
        "--seeds",
        "2",
        "--factor",
        "population=8,16,24",
        "--factor",
        "mutation_probability=0.02,0.05,0.1",
        "--factor",
        "crossover_trials+mutation_trials=2,5,10",
    ]
}

fn array(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

#[test]
fn a_killed_orthogonal_test_ends_with_the_same_bytes() {
    let rig = Rig::new();
    let (whole, killed) = (rig.path("whole"), rig.path("killed"));
    let object = rig.json(&small(&whole));
    let keys: Vec<&String> = object.as_object().unwrap().keys().collect();
    let all = [
        "array",
        "factors",
        "runs",
        "ranges",
        "anova",
        "confirmation",
    ];
    assert!(keys.len() == all.len() && all.iter().all(|key| object.get(key).is_some()));
    assert_eq!(object["array"], "L9");
    assert_eq!(
        object["factors"][0],
        json!({"name": "population", "levels": [8, 16, 24]})
    );
    let runs = array(&object["runs"]);
    assert_eq!(runs.len(), 18);
    assert!(
        runs.iter()
            .all(|run| run["evaluations"] == 60 && number(&run["objective"]) > 0.0)
    );
    assert_eq!(runs[1]["seed"], 2);
    assert_eq!(runs[1]["levels"]["crossover_trials+mutation_trials"], 2);
    // three factors of two degrees of freedom, one of seeds, ten left
    let anova = array(&object["anova"]);
    let freedom: Vec<&Value> = anova.iter().map(|term| &term["freedom"]).collect();
    assert_eq!(freedom, [2, 2, 2, 1, 10]);
    assert!(
        anova[..3]
            .iter()
            .all(|term| (0.0..=1.0).contains(&number(&term["p"])))
    );
    // the ranges are those of the runs
    let first: Vec<f64> = runs
        .iter()
        .filter(|run| run["levels"]["population"] == 8)
        .map(|run| number(&run["objective"]).log10())
        .collect();
    let mean = first.iter().sum::<f64>() / 6.0;
    assert!((number(&object["ranges"][0]["means"][0]) - mean).abs() < 1e-12);
    let confirmed = array(&object["confirmation"]["runs"]);
    let seeds: Vec<&Value> = confirmed.iter().map(|run| &run["seed"]).collect();
    assert_eq!(seeds, [3, 4]);
    let responses = confirmed
        .iter()
        .map(|run| number(&run["objective"]).log10());
    let obtained = responses.sum::<f64>() / 2.0;
    assert!((number(&object["confirmation"]["obtained"]) - obtained).abs() < 1e-12);
    foreign_terms::check_folder(whole.as_ref());

    let words: Vec<String> = small(&killed).into_iter().map(str::to_owned).collect();
    rig.kill_at(&words, &rig.file("killed"), 20_000, Duration::from_mins(1));
    assert!(
        !rig.file("killed/result.json").exists(),
        "it was killed too late"
    );
    assert_eq!(rig.json(&small(&killed)), object);
    let bytes = |run: &str| fs::read(rig.file(run).join("result.json")).unwrap();
    assert_eq!(bytes("whole"), bytes("killed"));
    // opened once more, nothing is computed
    let journal = || fs::metadata(rig.file("killed/journal.hhj")).unwrap().len();
    let before = journal();
    let text = rig.run(&small(&killed));
    assert!(journal() < before + 2_000, "{before}");
    for said in [
        "Best levels: population",
        "Range analysis",
        "Analysis of variance",
        "seed (blocks)",
    ] {
        assert!(text.contains(said), "{said}: {text}");
    }
    let page = fs::read_to_string(rig.file("killed/report.html")).unwrap();
    assert!(page.contains("<svg") && page.contains("crossover_trials+mutation_trials"));
}

#[test]
fn a_saturated_design_has_no_analysis_of_variance_and_budgets_that_differ_are_said_to() {
    let rig = Rig::new();
    let run = rig.path("run");
    let test = [
        &["sweep", "orthogonal", "CASE", "--run", &run, "--seeds", "1"][..],
        &[
            "--factor",
            "population=8,12,16",
            "--factor",
            "generations=1,2,3",
        ],
        &["--factor", "mutation_probability=0.02,0.05,0.1"],
        &["--factor", "crossover_probability=0.7,0.8,0.9"],
        &["--set", "crossover_trials=2,mutation_trials=2"],
    ]
    .concat();
    let object = rig.json(&test);
    assert_eq!(object["anova"], Value::Null);
    assert_eq!(array(&object["ranges"]).len(), 4);
    let runs = array(&object["runs"]);
    let budget = |run: &Value| run["evaluations"].as_u64().unwrap();
    assert!(budget(&runs[8]) > 2 * budget(&runs[0]), "{object}");
    let text = rig.run(&test);
    assert!(
        text.contains("saturated") && text.contains("Budgets differ"),
        "{text}"
    );
}

#[test]
fn factors_that_cannot_be_tested_are_refused() {
    let rig = Rig::new();
    let refused = |more: &[&str], said: &[&str]| {
        let run = rig.path("run");
        let words = [&["sweep", "orthogonal", "CASE", "--run", &run], more].concat();
        let error = rig.refused(&words);
        assert!(
            said.iter().all(|said| error.contains(said)),
            "{said:?}: {error}"
        );
        assert!(!rig.file("run").exists(), "nothing is begun");
    };
    refused(
        &["--factor", "populatoin=8,16,24"],
        &["factor populatoin", "did you mean `population`?"],
    );
    refused(
        &["--factor", "population=2,16,24"],
        &[
            "factor population",
            "population is 2, but must be 4 to 100000",
        ],
    );
    refused(
        &["--factor", "population=8,16"],
        &["factor population has 2 levels", "3 levels"],
    );
    refused(
        &["--factor", "population=8,16,8"],
        &["factor population: the value 8 is given twice"],
    );
    refused(
        &[
            "--factor",
            "population=8,16,24",
            "--factor",
            "population=8,16,32",
        ],
        &["`population` is set twice"],
    );
    let five = ["population=8,16,24"; 5].map(|factor| ["--factor", factor]);
    refused(&five.concat(), &["5 factors are too many", "up to 4"]);
}
