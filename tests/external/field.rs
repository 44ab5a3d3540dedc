//! Files that engineers and other programs write, each with what comes out and a further member of its kind.
use crate::rig::{Rig, copy, source};
use serde_json::Value;
use std::fs;

/// Creates a test folder with a copy of one input as `f`.
fn field(name: &str) -> Rig {
    let rig = Rig::new();
    copy(&source("external/field").join(name), &rig.file("f"));
    rig
}

/// Replaces text in a file of the input.
fn change(rig: &Rig, file: &str, from: &str, to: &str) {
    let path = rig.file("f").join(file);
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "{file}: {from}");
    fs::write(path, text.replace(from, to)).unwrap();
}

/// Imports the input's control file as `case`; returns its notes.
fn import(rig: &Rig) -> String {
    let made = rig.object(&["case", "import", "f/m.pst", "case"]);
    made["notes"].to_string()
}

/// Imports the input's control file, allows its program and descends; returns the result.
fn descent(rig: &Rig) -> Value {
    import(rig);
    rig.done(&["allow", "case"]);
    rig.object(&["calibrate", "case", "--preset", "descent", "--run", "run"])
}

/// Checks that a line was found: k, c and the objective.
fn is_line(result: &Value, [k, c]: [(&str, f64); 2]) {
    for (name, value) in [k, c] {
        let own = result["unknowns"][name]["value"].as_f64().unwrap();
        assert!((own - value).abs() < 1e-4, "{name}: {own}");
    }
    let phi = result["objective"]["optimised"].as_f64().unwrap();
    assert!(phi < 1e-6, "{phi}");
}

#[test]
fn a_field_too_narrow_for_its_difference_step_is_refused_with_the_width() {
    let rig = field("narrow-field");
    let said = rig.refused(&["case", "import", "f/m.pst", "case"]);
    for words in [
        "f/p.tpl: line 2",
        "`k` has 5 characters",
        "widen the field to 7",
    ] {
        assert!(said.contains(words), "{said}");
    }
    change(&rig, "p.tpl", "~ k ~", "~ k   ~");
    is_line(&descent(&rig), [("k", 0.02), ("c", 0.5)]);
}

#[test]
fn one_sided_groups_are_limits() {
    let rig = field("one-sided");
    let notes = import(&rig);
    for words in [
        "line 17: observation group `less_than`",
        "line 18: observation group `greater_than`",
    ] {
        assert!(notes.contains(words), "{notes}");
    }
    rig.done(&["allow", "case"]);
    let simulated = rig.object(&["simulate", "case"]);
    assert_eq!(simulated["objective"], 0.0);
    for command in ["diagnose", "identify"] {
        let said = rig.refused(&[command, "case"]);
        assert!(said.contains("channel `less_than` is a limit"), "{said}");
    }
    // only what exceeds its limit counts: 1.5 above 1, and 2.5 below 3
    let rig = field("one-sided");
    change(&rig, "m.pst", "less_than", "l_t");
    change(&rig, "m.pst", "greater_than", "g_t");
    change(&rig, "m.pst", "y1 5 ", "y1 1 ");
    change(&rig, "m.pst", "y4 2 ", "y4 7 ");
    import(&rig);
    rig.done(&["allow", "case"]);
    let simulated = rig.object(&["simulate", "case"]);
    let objective = simulated["objective"].as_f64().unwrap();
    assert!((objective - 6.5).abs() < 1e-9, "{objective}");
    let result = rig.object(&["calibrate", "case", "--preset", "descent", "--run", "run"]);
    let phi = result["objective"]["optimised"].as_f64().unwrap();
    assert!(phi < 1e-6, "{phi}");
}

#[test]
fn names_of_other_programs_stay() {
    let long = "pname:k_inst:0_ptype:gr_x:1.5";
    let rig = field("name-colon");
    is_line(&descent(&rig), [(long, 2.0), ("offset[0]", 1.0)]);
    for file in [
        "calibrated.par",
        "calibrated.toml",
        "tables.txt",
        "report.html",
    ] {
        let text = fs::read_to_string(rig.file("run").join(file)).unwrap();
        assert!(text.contains(long) && text.contains("offset[0]"), "{file}");
    }
    // what was written can be read
    let genes = ["simulate", "case", "--genes", "run/calibrated.toml"];
    assert!(rig.object(&genes)["objective"].as_f64().unwrap() < 1e-6);
    rig.done(&["export", "run"]);
    // an observation that is called as a parameter
    let rig = field("name-colon");
    change(&rig, "m.pst", "y1 3", "offset[0] 3");
    change(&rig, "y.ins", "!y1!", "!offset[0]!");
    is_line(&descent(&rig), [(long, 2.0), ("offset[0]", 1.0)]);
}

#[test]
fn words_that_pest_does_not_know_are_refused_by_line() {
    let rig = field("partrans");
    let said = rig.refused(&["case", "import", "f/m.pst", "case"]);
    assert!(said.contains("line 14: partrans = `logarithmic`"), "{said}");
    change(&rig, "m.pst", "k logarithmic", "k log");
    change(&rig, "m.pst", "g relative", "g relativ");
    let said = rig.refused(&["case", "import", "f/m.pst", "case"]);
    assert!(said.contains("line 12: inctyp = `relativ`"), "{said}");
}

#[test]
fn byte_order_marks_are_no_text() {
    let rig = field("bom");
    for file in ["p.tpl", "y.ins"] {
        let path = rig.file("f").join(file);
        let text = fs::read_to_string(&path).unwrap();
        fs::write(path, format!("\u{feff}{text}")).unwrap();
    }
    is_line(&descent(&rig), [("k", 2.0), ("c", 1.0)]);
}

#[test]
fn a_program_of_another_machine_is_a_note() {
    let rig = field("backslash");
    let notes = import(&rig);
    assert!(notes.contains(r"no program `.\\run_model.exe`"), "{notes}");
    assert!(notes.contains("Windows program"), "{notes}");
    let said = rig.refused(&["allow", "case"]);
    assert!(said.contains("there is no such program"), "{said}");
    let rig = field("backslash");
    change(
        &rig,
        "m.pst",
        r".\run_model.exe case.nam",
        "mf6-of-the-cluster",
    );
    let notes = import(&rig);
    assert!(notes.contains("no program `mf6-of-the-cluster`"), "{notes}");
}

#[test]
fn many_observations_in_many_groups_are_read() {
    for (groups, observations) in [(80, 8000), (1000, 20_000)] {
        let rig = field("bom");
        let names = (0..observations).map(|at| format!("o{at} 1 1.0 g{}\n", at % groups));
        let listed: Vec<String> = (0..groups).map(|at| format!("g{at}")).collect();
        let observed: String = names.collect();
        let text = fs::read_to_string(rig.file("f/m.pst")).unwrap();
        let text = text.replace("2 4 1 0 1", &format!("2 {observations} 1 0 {groups}"));
        let (before, rest) = text.split_once("* observation groups").unwrap();
        let (_, after) = rest.split_once("* model command").unwrap();
        let text = format!(
            "{before}* observation groups\n{}\n* observation data\n{observed}* model command{after}",
            listed.join("\n")
        );
        fs::write(rig.file("f/m.pst"), text).unwrap();
        let read: Vec<String> = (0..observations).map(|at| format!("l1 !o{at}!")).collect();
        fs::write(rig.file("f/y.ins"), format!("pif ~\n{}\n", read.join("\n"))).unwrap();
        let made = rig.object(&["case", "import", "f/m.pst", "case"]);
        assert_eq!(made["observations"], observations);
    }
}

#[test]
fn tables_of_a_control_file_have_any_separator() {
    let rig = field("external-semicolons");
    is_line(&descent(&rig), [("k", 2.0), ("c", 1.0)]);
    let rig = field("external-sep");
    is_line(&descent(&rig), [("k", 2.0), ("c", 1.0)]);
    let rig = field("external-sep");
    change(
        &rig,
        "m.pst",
        "par.csv sep w",
        "par.csv sep w missing_value ?",
    );
    change(&rig, "par.csv", "1 0 1 \n", "? ? 1 ?\n");
    is_line(&descent(&rig), [("k", 2.0), ("c", 1.0)]);
}

#[test]
fn separated_thousands_are_refused() {
    let rig = field("thousands");
    let said = rig.refused(&["case", "check", "f"]);
    assert!(said.contains("row 11, column `load_lb`: `1,008`"), "{said}");
    change(&rig, "thousands.tsv", ",", "");
    rig.done(&["case", "check", "f"]);
}

#[test]
fn drivers_of_dakota_get_its_files() {
    // the driver prints its parameters file, of which a failure shows the last lines
    for (name, line) in [
        (
            "dakota-aprepro",
            "                    { DAKOTA_AN_COMPS =                      0 }",
        ),
        (
            "dakota-components",
            "                                          0 analysis_components",
        ),
    ] {
        let rig = field(name);
        rig.done(&["allow", "f"]);
        let said = rig.refused(&["simulate", "f"]);
        assert!(said.contains(line), "{said}");
    }
    let rig = field("dakota-components");
    change(
        &rig,
        "case.toml",
        "dakota = \"standard\"",
        "dakota = \"standard\", components = [\"mesh 1.exo\"]",
    );
    rig.done(&["allow", "f"]);
    let said = rig.refused(&["simulate", "f"]);
    assert!(said.contains("mesh 1.exo AC_1:python3"), "{said}");
}

/// Checks that residuals of zero target are met, and that a driver's own gradients spare runs.
#[test]
fn drivers_that_return_residuals_have_the_target_zero() {
    let rig = field("zero-target");
    rig.done(&["case", "check", "f"]);
    change(&rig, "case.toml", "offset = \"fixed\"", "offset = \"free\"");
    let said = rig.refused(&["case", "check", "f"]);
    assert!(said.contains("offset = \"fixed\""), "{said}");
    let runs = |gradients: bool| {
        let rig = field("zero-target");
        change(
            &rig,
            "rosen.py",
            "open(sys.argv[2],'w').write('FAIL\\n')",
            "a=[l.split()[0] for l in L if 'ASV_' in l]\n\
             t='%.16e F1\\n%.16e f2\\n'%tuple(f)\n\
             if a[0]=='3': t+='[ %.16e 10 ]\\n[ -1 0 ]\\n'%(-20*x1)\n\
             open(sys.argv[2],'w').write(t)",
        );
        if gradients {
            change(
                &rig,
                "case.toml",
                "dakota = [\"f1\", \"f2\"]",
                "dakota = [\"f1\", \"f2\"], gradients = true",
            );
        }
        rig.done(&["allow", "f"]);
        let result = rig.object(&["calibrate", "f", "--preset", "descent", "--run", "run"]);
        for name in ["x1", "x2"] {
            let value = result["unknowns"][name]["value"].as_f64().unwrap();
            assert!((value - 1.0).abs() < 1e-4, "{name}: {value}");
        }
        result["evaluations"].as_u64().unwrap()
    };
    let (with, without) = (runs(true), runs(false));
    assert!(
        with < without,
        "{with} runs with gradients, {without} without"
    );
}

#[test]
fn a_residual_is_compared_with_the_noise_as_an_amplitude() {
    let rig = field("residual-ratio");
    rig.done(&["allow", "f"]);
    let result = rig.object(&["diagnose", "f", "--run", "run"]);
    let reason = result["reason"].as_str().unwrap();
    assert!(reason.contains("the residual is 2.26 times"), "{reason}");
}

#[test]
fn value_and_interval_show_digits_that_differ() {
    let rig = field("interval-rounding");
    rig.done(&["allow", "f"]);
    let table = rig.done(&["calibrate", "f", "--preset", "descent", "--run", "run"]);
    let line = table
        .lines()
        .find(|line| line.trim().starts_with("k "))
        .unwrap();
    let (low, high) = line.rsplit_once(" to ").unwrap();
    let low = low.split_whitespace().last().unwrap();
    assert_ne!(low, high.trim(), "{line}");
    assert!(
        low.starts_with("2.99") && high.trim().starts_with("3.00"),
        "{line}"
    );
}

#[test]
fn tables_of_programs_are_read_as_records_are() {
    let rig = field("output-decimal-comma");
    rig.done(&["allow", "f"]);
    let plain = rig.object(&["simulate", "f"])["objective"].clone();
    // the same table in blanks, with a preamble and units, in Latin-1
    change(
        &rig,
        "m.py",
        "o.write(\"t;y\\n\")",
        "o=open(\"out.csv\",\"w\",encoding=\"latin-1\"); o.write(\"Solver, 2\u{b5}\\n\\nt  y\\ns  N\\n\")",
    );
    change(&rig, "m.py", "%.3f;%.6f\\n", "%.3f  %.6f\\n\\n");
    rig.done(&["allow", "f"]);
    assert_eq!(rig.object(&["simulate", "f"])["objective"], plain);
}

#[test]
fn records_may_have_blanks_preambles_and_units() {
    let rig = field("record-blanks");
    rig.done(&["case", "check", "f"]);
    let rig = field("preamble-units");
    let said = rig.refused(&["case", "check", "f"]);
    assert!(said.contains("row 17, column `ms`: 0"), "{said}");
    change(&rig, "case.toml", "at = \"ms\"", "at = \"Number\"");
    rig.done(&["case", "check", "f"]);
}

#[test]
fn loads_in_another_unit_are_noted() {
    let rig = Rig::new();
    copy(&source("../cases/cyjs10-5-37hb"), &rig.file("f"));
    let card = source("external/field/card-in-pounds/card_4rpm.csv");
    fs::copy(card, rig.file("f/measured/card_4rpm.csv")).unwrap();
    let notes = rig.object(&["case", "check", "f"])["notes"].to_string();
    assert!(notes.contains("4rpm: the record of gauge 1"), "{notes}");
}

#[test]
fn an_element_is_named_by_its_tag() {
    let rig = Rig::new();
    copy(&source("../cases/cyjs10-5-37hb"), &rig.file("f"));
    let mesh = source("external/field/mesh-element-number/head.msh");
    fs::copy(mesh, rig.file("f/back_head/back_head.msh")).unwrap();
    let said = rig.refused(&["head", "f"]);
    assert!(said.contains("element 500 of group `steel`"), "{said}");
}
