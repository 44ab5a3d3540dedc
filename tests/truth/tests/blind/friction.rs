//! Diagnosis of a record with strong hidden friction: imported from raw files, killed, resumed, scored, its effect added to the case,
//! reported again and simulated, with equal numbers throughout. One test with one diagnosis, since it takes
//! minutes.
use crate::{
    coarse::{FRICTION, Trial, run},
    raw::import_again,
};
use protocol::{curve::rounded, pumping_unit::Sensor};
use serde_json::Value;
use std::{collections::BTreeMap, fs, path::Path, process::Stdio, thread::sleep, time::Duration};

/// Size of the diagnosis journal (progress file) at which the diagnosis is killed \[bytes\]; far less than a
/// complete journal.
const KILLED_AT: u64 = 500_000;

/// Parses the JSON output of a diagnosis and removes its times, so that outputs of repeated runs are
/// comparable.
fn said(text: &str) -> Value {
    let mut all: Value = serde_json::from_str(text).expect("an object");
    let fields = all.as_object_mut().expect("an object");
    fields.remove("wall_s").expect("a time");
    for stage in fields["stages"].as_array_mut().expect("stages") {
        stage.as_object_mut().expect("a stage").remove("busy_s");
    }
    all
}

/// Converts the estimated nuisance parameters of a diagnosis to `[[effects]]` tables of a case file.
fn instruments(whole: &Value) -> String {
    let mut tables: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for own in whole["nuisances"].as_array().expect("a list") {
        let word = |key: &str| own[key].as_str().expect("a word");
        // gains of channels that no gauge shows are no effects
        if !["position_gain", "torque_gain"].contains(&word("id")) {
            let (name, value, unit) = (word("parameter"), &own["value"], word("unit"));
            let number = format!("{name} = {{ value = {value}, unit = \"{unit}\" }}");
            tables.entry(word("id")).or_default().push(number);
        }
    }
    assert!(tables.len() >= 4, "{tables:?}");
    let table = |(id, numbers): (&str, Vec<String>)| {
        let numbers = numbers.join(", ");
        format!("\n[[effects]]\nid = \"{id}\"\nparameters = {{ {numbers} }}\n")
    };
    tables.into_iter().map(table).collect()
}

/// Reads from `curves.csv` the stress of each gauge that the diagnosis simulated with the added effects,
/// every half degree of crank angle.
fn after(curves: &Path, condition: &str) -> [Vec<f64>; 4] {
    let text = fs::read_to_string(curves).expect("curves");
    let mut gauges: [Vec<f64>; 4] = Default::default();
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let gauge = fields[1].strip_prefix("gauge ").map(str::parse::<usize>);
        if let (true, Some(Ok(gauge))) = (fields[0] == condition, gauge) {
            gauges[gauge - 1].push(fields[7].parse().expect("a stress"));
        }
    }
    gauges
}

/// Checks that the balance of the diagnosis compares the machine with and without the friction, which costs its work over
/// two swings of the beam in each revolution, and that the report of the diagnosis shows it.
fn friction_costs_its_work(trial: &Trial, whole: &Value) {
    let balance = run(&mut trial.horsehead(&["balance", "run", "--output", "json"]));
    let balance: Value = serde_json::from_str(&balance).expect("an object");
    let variants = balance["variants"].as_array().expect("machines");
    let names: Vec<&str> = variants
        .iter()
        .filter_map(|own| own["name"].as_str())
        .collect();
    let expected = [
        "recommended",
        "recalibrated",
        "diagnosed without pivot_friction",
        "diagnosed",
    ];
    assert_eq!(names, expected);
    let energy = |own: &Value| {
        let energy = &own["conditions"][0]["energy_kwh_per_day"]["value"];
        energy.as_f64().expect("an energy")
    };
    let cost = energy(&variants[3]) - energy(&variants[2]);
    let moment = &whole["effects"][0]["parameters"]["moment"]["value"];
    // 63.7 deg twice in each of 7,200 revolutions
    let work = moment.as_f64().expect("a moment") * 2.0 * 1.111 * 7200.0 / 3.6e6;
    assert!((0.5..2.0).contains(&(cost / work)), "{cost} {work}");
    run(&mut trial.horsehead(&["report", "run", "--output", "json"]));
    let page = fs::read_to_string(trial.at("run/report.html")).expect("a page");
    assert!(page.contains("id=\"balance\""));
}

#[test]
fn a_strong_friction_is_named_added_told_again_and_simulated_with_the_same_numbers() {
    let trial = Trial::make(&FRICTION);
    // from the raw files of a logger and a dynamometer
    import_again(&trial);
    // killed on the way
    let mut first = trial.diagnose();
    let mut first = first.stdout(Stdio::null()).spawn().expect("it starts");
    let journal = trial.at("run/journal.hhj");
    while fs::metadata(&journal).map_or(0, |file| file.len()) < KILLED_AT {
        assert!(
            first.try_wait().expect("a state").is_none(),
            "it ended before"
        );
        sleep(Duration::from_millis(20));
    }
    first.kill().expect("a signal");
    first.wait().expect("an end");
    assert!(!trial.at("run/result.json").exists());

    let verdict = run(&mut trial.diagnose());
    let whole = said(&verdict);
    assert_eq!(whole["verdict"], "named", "{whole}");
    assert_eq!(whole["effects"][0]["id"], "pivot_friction", "{whole}");
    let table = trial.open(&verdict);
    eprintln!("{table}");
    assert!(table.contains("| single: first name right |  | 1/1 = 100 %"));
    assert!(table.contains("| false names of all names | <= 10 % | 0/1 = 0 %"));

    // the case has what was found, once, and the run still knows its case
    for _ in 0..2 {
        assert_eq!(said(&run(trial.diagnose().arg("--add"))), whole);
    }
    let case = fs::read_to_string(trial.at("case/case.toml")).expect("a case");
    assert_eq!(case.matches("id = \"pivot_friction\"").count(), 1);
    // the next calibration fits it: its size is a gene of the case, within an interval about it
    let checked = run(&mut trial.horsehead(&["case", "check", "case", "--output", "json"]));
    let checked: Value = serde_json::from_str(&checked).expect("an object");
    let genes = checked["genes"].as_array().expect("genes");
    assert!(genes.len() > 10, "{genes:?}");
    assert!(genes.contains(&"pivot_friction.moment".into()), "{genes:?}");
    assert!(case.contains(", search = ["), "{case}");
    assert_eq!(
        said(&run(
            &mut trial.horsehead(&["report", "run", "--output", "json"])
        )),
        whole
    );

    friction_costs_its_work(&trial, &whole);

    // with the step of the diagnosis, and the instruments off by what it says, a simulation of the case is
    // its "after": rounded as channels of a diagnosis are
    let usual = "longest_step_s = 0.06 ";
    assert_eq!(case.matches(usual).count(), 1);
    let finer = format!("longest_step_s = {:e} ", 0.7 * 0.06);
    let case = case.replace(usual, &finer) + &instruments(&whole);
    fs::write(trial.at("case/case.toml"), case).expect("a case");
    let mut simulate = trial.horsehead(&["simulate", "case", "--output", "json", "--measured"]);
    simulate
        .arg(&trial.set)
        .args(["--genes", "run/calibrated.toml"]);
    let simulated: Value = serde_json::from_str(&run(&mut simulate)).expect("an object");
    let after = after(&trial.at("run/curves.csv"), "5rpm");
    for (gauge, diagnosed) in (1..).zip(&after) {
        let stress = &simulated["gauge_mpa"][gauge.to_string()];
        let stress = stress.as_array().expect("a curve");
        let stress: Vec<f64> = stress.iter().filter_map(Value::as_f64).collect();
        let exponent = Sensor::Gauge(1).channel(0, Vec::new()).step;
        let exponent = exponent.expect("a step");
        assert_eq!(stress.len(), 720);
        // the numbers of the instruments were written and read: a last digit may tip a rounding
        let stress = rounded(&stress, exponent);
        let apart = stress.iter().zip(diagnosed);
        let apart = apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart <= 2.0_f64.powi(exponent), "gauge {gauge}: {apart}");
    }
}
