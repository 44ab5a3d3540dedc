//! A case that has a mesh and gauges, but no tables of its back head.
use serde_json::Value;
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

/// Copies the shipped case without the tables of its back head.
fn without_tables(to: &Path) -> PathBuf {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    for name in [
        "case.toml",
        "back_head/back_head.msh",
        "measured/card_5rpm.csv",
        "measured/card_4rpm.csv",
        "measured/test_5rpm.csv.gz",
        "measured/test_5rpm.toml",
        "measured/test_4rpm.csv.gz",
        "measured/test_4rpm.toml",
    ] {
        let place = to.join(name);
        fs::create_dir_all(place.parent().unwrap()).unwrap();
        fs::copy(from.join(name), place).unwrap();
    }
    to.join("case.toml")
}

fn run(words: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_horsehead"))
        .args(words)
        .current_dir(folder)
        .env("XDG_STATE_HOME", folder.join("state"))
        .output()
        .unwrap()
}

fn failed(words: &[&str], folder: &Path) -> String {
    let output = run(words, folder);
    assert!(!output.status.success(), "{words:?}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn printed(words: &[&str], folder: &Path) -> String {
    let output = run(words, folder);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words:?}: {errors}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Calibrates the case of a folder with three points and returns the result.
fn calibrated(folder: &Path) -> Value {
    let calibrate = [
        "calibrate",
        "case",
        "--preset",
        "random",
        "--set",
        "points=3",
        "--run",
        "a",
        "--output",
        "json",
    ];
    serde_json::from_str(&printed(&calibrate, folder)).unwrap()
}

/// Checks that mesh and gauges alone make the tables, which a calibration then uses, and that `case check` says what
/// moving a gauge changes.
#[test]
fn mesh_and_gauges_alone_make_a_case_that_calibrates() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let case_file = without_tables(&folder.join("case"));
    let missing = failed(&["case", "check", "case"], folder);
    for part in [
        "back_head_modes.json: no such file",
        "help: `horsehead head CASE --write` computes both tables",
    ] {
        assert!(missing.contains(part), "{part}: {missing}");
    }
    let text = printed(&["head", "case", "--write", "--output", "json"], folder);
    let object: Value = serde_json::from_str(&text).unwrap();
    let gauge = &object["gauges"]["1"];
    assert!(
        gauge["surface_distance_m"].as_f64().unwrap() < 1e-6,
        "{gauge}"
    );
    let stress = gauge["largest_wrap_stress_mpa"].as_f64().unwrap();
    let per_m = gauge["largest_wrap_gradient_mpa_per_m"][0]
        .as_f64()
        .unwrap();
    // 19 mm further the stress is another by more than a third
    assert!(
        (0.2..0.6).contains(&(0.019 * per_m / stress).abs()),
        "{gauge}"
    );

    let summary = printed(&["case", "check", "case"], folder);
    for part in [
        "gauge 1   at (-1.0606, 0.2350, 0.1600) m, 12 mm along y, 0.0 mm from the surface",
        "kN of rope tension, moved by 1 mm along x, y, z: +2.3 %",
    ] {
        assert!(summary.contains(part), "{part}: {summary}");
    }
    let result = calibrated(folder);
    let machine = result["machine"].as_array().unwrap();
    let stroke = machine
        .iter()
        .find(|own| own["quantity"] == "stroke")
        .unwrap();
    assert!(
        (stroke["measured"].as_f64().unwrap() - 3.972).abs() < 1e-3,
        "{stroke}"
    );
    assert!(
        (stroke["before"].as_f64().unwrap() - 3.97).abs() < 0.01,
        "{stroke}"
    );

    refuses_other_gauges(folder, &case_file);
}

/// Checks that the objective is the weighted sum of the errors of gauges, position and torque, in the units that the
/// case states.
#[test]
fn position_and_torque_are_terms_of_the_objective() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb/back_head");
    let case_file = without_tables(&folder.join("case"));
    for name in ["back_head_modes.json", "back_head_influence.csv"] {
        fs::copy(shipped.join(name), folder.join("case/back_head").join(name)).unwrap();
    }
    let text = fs::read_to_string(&case_file).unwrap();
    let terms = "position_weight_mpa2_per_m2 = 250.0\ntorque_weight_mpa2_per_kn2_m2 = 0.5\noffset = \"free\"";
    fs::write(&case_file, text.replace("offset = \"free\"", terms)).unwrap();
    let result = calibrated(folder);
    for which in ["recommended", "optimised"] {
        let mse = |channel: &str, key: &str| {
            let value = &result["channels"][channel][which][key];
            value
                .as_f64()
                .unwrap_or_else(|| panic!("{channel}: {value}"))
        };
        let sum = mse("1", "mse")
            + mse("3", "mse")
            + 250.0 * mse("position", "mse")
            + 0.5e-6 * mse("torque", "mse_fixed_offset");
        let objective = result["objective"][which].as_f64().unwrap();
        assert!(mse("torque", "mse") > 1e4, "{result}");
        assert!((sum / objective - 1.0).abs() < 1e-9, "{sum} {objective}");
    }
}

/// Checks that gauges that are moved or turned make the tables out of date, and that gauges and units that cannot be
/// are refused.
fn refuses_other_gauges(folder: &Path, case_file: &Path) {
    let text = fs::read_to_string(case_file).unwrap();
    let turned =
        "x_m = -1.060622, y_m = 0.235, z_m = 0.16, length_m = 0.012, direction = [1.0, 1.0, 0.0]";
    let place = "x_m = -1.060622, y_m = 0.235, z_m = 0.16, length_m = 0.012";
    fs::write(case_file, text.replace(place, turned)).unwrap();
    let stale = failed(&["case", "check", "case"], folder);
    for part in ["gauges", "computes the tables again"] {
        assert!(stale.contains(part), "{part}: {stale}");
    }
    printed(&["head", "case", "--write"], folder);
    let summary = printed(&["case", "check", "case"], folder);
    assert!(
        summary.contains("12 mm along (0.71, 0.71, 0.00)"),
        "{summary}"
    );
    let beside = place.replace("z_m = 0.16", "z_m = 0.30");
    fs::write(case_file, text.replace(place, &beside)).unwrap();
    let outside = failed(&["head", "case"], folder);
    assert!(outside.contains("gauge 1"), "{outside}");
    for (wrong, expected) in [
        (text.replace(place, "x_m = 0.1"), "missing field `y_m`"),
        (
            text.replace("gauges.4", "gauges.5"),
            "the gauges 1, 2, 3 and 4",
        ),
        (
            text.replace(place, &turned.replace("[1.0, 1.0, 0.0]", "[0.0, 0.0, 0.0]")),
            "a direction that is not zero",
        ),
        (
            text.replace(
                "density_kg_m3 = 7850.0                                 # steel",
                "mesh_unit_m = 0.001\ndensity_kg_m3 = 7850.0 # steel",
            ),
            "the distance of the group `rope_surface` from the head's centre",
        ),
    ] {
        fs::write(case_file, wrong).unwrap();
        let errors = failed(&["head", "case", "--write"], folder);
        assert!(errors.contains(expected), "{expected}: {errors}");
        assert!(errors.contains("help: "), "{errors}");
    }
}
