//! End-to-end tests of commands that no other suite runs, with the program, a worker process and the shipped
//! case.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of tests: a command that cannot be run or read has failed"
)]
mod balance;
mod head_from_mesh;
mod life;

use serde_json::Value;
use std::{fs, path::Path, process::Command};

/// Runs a command with `--output json` and returns the object that it prints.
fn json(arguments: &[&str]) -> Value {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    let output = Command::new(env!("CARGO_BIN_EXE_horsehead"))
        .args(arguments.iter().map(|word| match *word {
            "CASE" => case.as_os_str(),
            other => other.as_ref(),
        }))
        .args(["--output", "json"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// Copies the shipped case with other text of its file.
fn changed_case(folder: &Path, change: impl Fn(String) -> String) -> String {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    for part in ["back_head", "measured"] {
        fs::create_dir_all(folder.join(part)).unwrap();
        for file in fs::read_dir(shipped.join(part)).unwrap() {
            let file = file.unwrap().path();
            fs::copy(&file, folder.join(part).join(file.file_name().unwrap())).unwrap();
        }
    }
    let text = fs::read_to_string(shipped.join("case.toml")).unwrap();
    let changed = change(text.clone());
    assert_ne!(text, changed);
    fs::write(folder.join("case.toml"), changed).unwrap();
    folder.to_str().unwrap().to_owned()
}

/// Checks `horsehead head` on the shipped mesh: frequencies as in the table, exact stress close to the table,
/// and a VTU file with stress and the displacement of every mode.
#[test]
fn head_reduces_the_shipped_mesh_and_draws_it() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().to_str().unwrap();
    let symmetric = ["head", "CASE", "--modes", "3", "--family", "symmetric"];
    let object = json(&[&symmetric[..], &["--vtu", folder, "--out", folder]].concat());
    let modes = object["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 3);
    for mode in modes {
        let (ours, table) = (
            number(&mode["frequency_hz"]),
            number(&mode["table_frequency_hz"]),
        );
        assert!((ours / table - 1.0).abs() < 0.01, "{ours} {table}");
        assert!(number(&mode["mac"]) > 0.99);
    }
    assert!((number(&object["mass_kg"]) - 881.0).abs() < 0.1);
    for gauge in ["1", "2", "3", "4"] {
        let gauge = &object["gauges"][gauge];
        let exact = number(&gauge["exact_half_range_mpa"]);
        let table = number(&gauge["table_half_range_mpa"]);
        assert!((exact / table - 1.0).abs() < 1e-3, "{exact} {table}");
    }
    let picture = fs::read_to_string(scratch.path().join("head.vtu")).unwrap();
    let fields = picture.matches("<DataArray").count();
    assert!(
        picture.contains("<UnstructuredGrid>") && fields >= 3 + 3,
        "{fields}"
    );
    assert!(picture.contains("stress"));
    let shapes = fs::read_to_string(scratch.path().join("head_modes.svg")).unwrap();
    for mode in modes {
        let label = format!("{:.1} Hz", number(&mode["frequency_hz"]));
        assert!(shapes.contains(&label), "{label}");
    }
}

/// Checks that `horsehead head` selects modes by their coupling to the loads of a turn, most of which falls
/// to the strongest mode, and that modes left out are reported and couple less.
#[test]
fn head_picks_the_modes_that_couple() {
    let object = json(&["head", "CASE", "--modes", "3"]);
    let couplings = |list: &Value| -> Vec<f64> {
        let modes = list.as_array().unwrap().iter();
        modes.map(|mode| number(&mode["coupling"])).collect()
    };
    let (kept, left) = (couplings(&object["modes"]), couplings(&object["left_out"]));
    let least = kept.iter().copied().fold(1.0, f64::min);
    let most = left.iter().copied().fold(0.0, f64::max);
    assert_eq!(kept.len(), 3);
    assert!(least > most && most > 0.0, "{least} {most}");
    assert!((0.97..1.0).contains(&kept.iter().copied().fold(0.0, f64::max)));
    for mode in object["left_out"].as_array().unwrap() {
        let symmetric = mode["family"] == "symmetric";
        assert_eq!(number(&mode["coupling"]) > 0.0, symmetric, "{mode}");
    }
}
