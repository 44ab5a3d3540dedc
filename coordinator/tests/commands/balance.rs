//! `horsehead balance` on the shipped case: torque, energy and counterweight against simulations of their own, and inputs
//! that cannot be meant.
use crate::{changed_case, json, number};
use serde_json::Value;
use std::{f64::consts::TAU, fs, path::Path, process::Command};

/// Returns the simulated torque of a case at a condition [N m], and the work of the crank pin \[J\].
fn simulated(case: &str, condition: &str) -> (Vec<f64>, f64) {
    let object = json(&["simulate", case, "--condition", condition]);
    let torque = object["crank_torque_nm"].as_array().unwrap().iter();
    (
        torque.map(number).collect(),
        number(&object["energy"]["input_j"]),
    )
}

fn rms(torque: &[f64]) -> f64 {
    (torque.iter().map(|x| x * x).sum::<f64>() / torque.len() as f64).sqrt()
}

/// Checks torque and energy against the simulation and its energy balance, the best moment against simulations of cases
/// with other moments, and the move of the weights against their weight.
#[test]
fn the_best_moment_is_the_best_of_simulated_ones_and_energy_is_that_of_the_ledger() {
    let scratch = tempfile::tempdir().unwrap();
    let run = scratch.path().join("balance");
    let object = json(&["balance", "CASE", "--run", run.to_str().unwrap()]);
    let present = &object["present"]["conditions"][0];
    let (torque, work) = simulated("CASE", "5rpm");
    let largest = torque.iter().copied().fold(f64::MIN, f64::max);
    assert!((number(&present["largest_n_m"]["value"]) / largest - 1.0).abs() < 1e-12);
    assert!((number(&present["rms_n_m"]["value"]) / rms(&torque) - 1.0).abs() < 1e-12);
    // five revolutions a minute for 24 hours; the sum of the samples against the integral over the steps
    let a_day = work * 5.0 * 60.0 * 24.0 / 3.6e6;
    let energy = number(&present["energy_kwh_per_day"]["value"]);
    assert!((energy / a_day - 1.0).abs() < 2e-3, "{energy} {a_day}");
    let mean_power = number(&present["mean_power_w"]);
    assert!((mean_power - number(&present["mean_n_m"]) * 5.0 / 60.0 * TAU).abs() < 1e-6);

    let best = &object["best"]["conditions"][0];
    let moment = number(&best["moment_n_m"]);
    let least = number(&best["rms_n_m"]["value"]);
    assert!(least < rms(&torque));
    // what each other moment gives in a simulation
    for (k, change) in [0.97, 0.99, 1.0, 1.01, 1.03].into_iter().enumerate() {
        let folder = scratch.path().join(format!("case{k}"));
        let case = changed_case(&folder, |text| {
            let stated = format!("counterweight_moment_n_m = {}", change * moment);
            text.replacen("counterweight_moment_n_m = 106.2e3", &stated, 1)
        });
        let other = rms(&simulated(&case, "5rpm").0);
        assert!(other >= least * (1.0 - 1e-9), "{change}: {other} {least}");
        assert_eq!(
            (other / least - 1.0).abs() < 1e-6,
            k == 2,
            "{other} {least}"
        );
    }
    let practice = &object["practice"][0];
    let change = number(&practice["moment_n_m"]);
    assert!((change - (moment - 106.2e3)).abs() < 1e-6);
    let by = number(&practice["move_by_m"]);
    assert!((by * 4.0 * 1284.0 * 9.81 - change).abs() < 1e-6);
    for file in [
        "report.html",
        "torque.csv",
        "result.json",
        "figures/counterweight_map.svg",
    ] {
        assert!(run.join(file).is_file(), "{file}");
    }
}

/// Checks that the least peak is not above that of the least root mean square and the reverse, for a mix of conditions
/// with a free phase, and that weights take one of their positions.
#[test]
fn each_goal_is_least_for_its_own_counterweight() {
    let scratch = tempfile::tempdir().unwrap();
    let run = scratch.path().join("balance");
    let mix = ["balance", "CASE", "--run", run.to_str().unwrap()];
    let mix = [
        &mix[..],
        &["--hours", "5rpm=16,4rpm=8", "--phase", "-10..10"],
    ]
    .concat();
    let [of_rms, of_peak] =
        ["rms", "peak"].map(|goal| json(&[&mix[..], &["--goal", goal]].concat()));
    let conditions = |of: &Value| of["best"]["conditions"].as_array().unwrap().clone();
    let peak = |of: &Value| {
        let each = conditions(of).into_iter();
        let each =
            each.map(|own| number(&own["largest_n_m"]["value"]).max(-number(&own["least_n_m"])));
        each.fold(0.0, f64::max)
    };
    let mean_square = |of: &Value| {
        let each = conditions(of).into_iter().zip([2.0 / 3.0, 1.0 / 3.0]);
        each.map(|(own, share)| share * number(&own["rms_n_m"]["value"]).powi(2))
            .sum::<f64>()
    };
    assert!(mean_square(&of_rms) < mean_square(&of_peak));
    assert!(peak(&of_peak) < peak(&of_rms));
    assert!((number(&of_peak["best"]["goal_n_m"]) / peak(&of_peak) - 1.0).abs() < 1e-12);
    let phase = number(&of_rms["best"]["best_phase_deg"]);
    assert!((-10.0..=10.0).contains(&phase));

    let stepped = json(&[&mix[..], &["--step", "2500", "--moment", "90e3..125e3"]].concat());
    let moment = number(&stepped["best"]["best_moment_n_m"]["value"]);
    assert!(((moment - 90e3) / 2500.0).fract().abs() < 1e-9, "{moment}");
}

/// Checks that a case without a rating says so, that the shipped record has the sign of the simulated torque, and that
/// bounds without the present weights, and other options that cannot be meant, are refused.
#[test]
fn what_cannot_be_meant_is_named_with_a_remedy() {
    let scratch = tempfile::tempdir().unwrap();
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    let shipped = shipped.to_str().unwrap();
    let run = |case: &str, words: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_horsehead"))
            .args(["balance", case])
            .args(words)
            .current_dir(scratch.path())
            .output()
            .unwrap();
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), errors)
    };
    for (words, parts) in [
        (vec!["--moment", "110e3..120e3"], vec!["106200", "--moment"]),
        (vec!["--moment", "120e3..110e3"], vec!["--moment", "larger"]),
        (vec!["--moment", "1e5"], vec!["--moment", "90e3..120e3"]),
        (vec!["--moment=-5..1e6"], vec!["--moment", "-5"]),
        (
            vec!["--phase", "2..8"],
            vec!["--phase", "counterweight_phase_deg"],
        ),
        (vec!["--rating", "0"], vec!["--rating", "positive"]),
        (vec!["--step", "nan"], vec!["--step", "positive"]),
        (vec!["--hours", "6rpm=3"], vec!["6rpm", "5rpm, 4rpm"]),
    ] {
        let (code, errors) = run(shipped, &words);
        assert_eq!(code, Some(2), "{words:?}: {errors}");
        for part in parts {
            assert!(errors.contains(part), "{words:?}: {part}\n{errors}");
        }
    }
    let folder = scratch.path().join("case");
    let unrated = changed_case(&folder, |text| {
        let lines = text.lines();
        let kept = lines.filter(|line| !line.starts_with("reducer_rating_n_m"));
        kept.collect::<Vec<_>>().join("\n")
    });
    let (code, errors) = run(&unrated, &["--output", "json"]);
    assert_eq!(code, Some(0), "{errors}");
    assert!(errors.contains("reducer_rating_n_m"), "{errors}");
    assert!(!errors.contains("opposite sign"), "{errors}");
    let result = fs::read_dir(scratch.path().join("runs")).unwrap().next();
    let result = result.unwrap().unwrap().path().join("result.json");
    let result: Value = serde_json::from_slice(&fs::read(result).unwrap()).unwrap();
    assert!(result["rating_n_m"].is_null());
    assert!(result["present"]["conditions"][0]["above_rating"].is_null());
}
