//! Tests of `sweep scaling`: the structure of the JSON object, and that existing rows are not measured again.
use crate::{
    foreign_terms,
    rig::{Rig, number},
};
use serde_json::Value;
use std::fs;

fn rows(object: &Value) -> &[Value] {
    object["rows"].as_array().map_or(&[], Vec::as_slice)
}

#[test]
fn slots_are_measured_and_rows_are_kept() {
    let rig = Rig::new();
    let run = rig.path("run");
    let words = "sweep scaling CASE --presets window,least-squares --populations 8 --evaluations 40 \
                 --crews 2,1 --run";
    let words: Vec<&str> = words.split_whitespace().chain([&*run]).collect();
    let object = rig.json(&words);
    let told: Vec<(&str, u64)> = rows(&object)
        .iter()
        .map(|row| (row["how"].as_str().unwrap(), row["slots"].as_u64().unwrap()))
        .collect();
    assert_eq!(
        told,
        [
            ("computed", 1),
            ("computed", 2),
            ("computed", 1),
            ("computed", 2)
        ]
    );
    for row in rows(&object) {
        let population = match row["preset"].as_str().unwrap() {
            "window" => 8.into(),
            _ => Value::Null,
        };
        assert_eq!(row["population"], population, "{row}");
        let shares = row["shares"].as_object().unwrap();
        assert_eq!(shares.len(), 6);
        let all: f64 = shares.values().map(number).sum();
        assert!((all - 1.0).abs() < 1e-6, "{row}");
        let speed_up = number(&row["speed_up"]);
        let efficiency = number(&row["efficiency"]);
        assert!(
            (speed_up / number(&row["slots"]) / efficiency - 1.0).abs() < 1e-9,
            "{row}"
        );
        assert!(number(&row["useful_s"]) > 0.0 && number(&row["coordinator_us_per_result"]) > 0.0);
    }
    for row in rows(&object) {
        for key in ["simulation_s", "derivatives_over_plain"] {
            assert!(number(&row[key]) > 0.0, "{row}");
        }
        let quantiles = row["simulation_quantiles_s"].as_array().unwrap();
        assert_eq!(quantiles.len(), 21);
        let pairs = quantiles.windows(2);
        assert!(
            pairs
                .into_iter()
                .all(|pair| number(&pair[0]) <= number(&pair[1]))
        );
    }
    foreign_terms::check_folder(run.as_ref());
    let page = fs::read_to_string(rig.file("run/report.html")).unwrap();
    assert!(
        page.contains("Where slot time went") && page.contains("Computing times of simulations")
    );
    assert!(rig.file("run/figures/speed_up.svg").exists());
    // what is there is kept, what is not is measured
    fs::remove_file(rig.file("run/computed-window-8-2.json")).unwrap();
    let again = rig.json(&words);
    let kept = |object: &Value| [0, 2, 3].map(|at| rows(object)[at]["wall_s"].clone());
    assert_eq!(kept(&again), kept(&object));
    assert_ne!(rows(&again)[1]["wall_s"], rows(&object)[1]["wall_s"]);
}

/// Checks that rows are computed on workers that were started by hand and are waited for, on the largest number
/// first, and that those which a smaller number leaves out end.
#[test]
fn workers_that_come_by_themselves_are_waited_for() {
    let rig = Rig::new();
    let run = rig.path("run");
    let address = format!("unix/{}", rig.path("socket/bus"));
    let workers = [(); 2].map(|()| rig.worker(&address));
    let words = "sweep scaling CASE --presets least-squares --evaluations 30 --crews 0 --nodes 1,2";
    let words = words.split_whitespace();
    let words: Vec<&str> = words.chain(["--listen", &address, "--run", &run]).collect();
    let object = rig.json(&words);
    let told = rows(&object)
        .iter()
        .map(|row| (row["how"].as_str().unwrap(), row["slots"].as_u64().unwrap()));
    assert_eq!(told.collect::<Vec<_>>(), [("remote", 1), ("remote", 2)]);
    for row in rows(&object) {
        assert!(row["evaluations"].as_u64().unwrap() >= 30, "{row}");
    }
    // 3: it was asked to end, and is not to be started again
    let mut codes = workers.map(|mut worker| worker.wait().unwrap().code());
    codes.sort_unstable();
    assert_eq!(codes, [Some(0), Some(3)]);
}

#[test]
fn searches_that_cannot_be_scaled_are_refused() {
    let rig = Rig::new();
    let run = rig.path("run");
    let refused = |words: &[&str], said: &str| {
        let command = ["sweep", "scaling", "CASE", "--run", &run];
        let error = rig.refused(&[&command[..], words].concat());
        assert!(error.contains(said), "{error}");
        assert!(!rig.file("run").exists(), "nothing is begun");
    };
    refused(&["--presets", "papier"], "possible values");
    refused(&["--crews", "0"], "there is nothing to measure on");
    refused(&["--nodes", "2"], "none can connect");
    let listen = ["--listen", "unix/socket/bus"];
    refused(&listen, "how many to wait for with --nodes");
    let hosts = ["--ssh", "a,b", "--nodes", "3"];
    refused(&hosts, "there are 2 hosts");
}
