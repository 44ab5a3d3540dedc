//! Tests of calibrations that fit one model to the records of several conditions.
use crate::rig::Rig;
use std::fs;

/// Creates a case whose model is the line `y = a + gain b` with one measured value per condition, so that no
/// single condition determines `a` and `b`.
fn line(fitted: &str) -> Rig {
    let rig = Rig::new();
    let folder = rig.file("case");
    fs::create_dir_all(&folder).unwrap();
    let program = "read a b gain < in.txt\n\
                   echo time,y > out.csv\n\
                   awk -v a=$a -v b=$b -v g=$gain 'BEGIN { printf \"0,%.17g\\n\", a + g * b }' >> out.csv\n";
    fs::write(folder.join("model.sh"), program).unwrap();
    fs::write(folder.join("in.tpl"), "{a} {b} {gain}\n").unwrap();
    fs::write(folder.join("low.csv"), "time,y\n0,3\n").unwrap();
    fs::write(folder.join("high.csv"), "time,y\n0,5\n").unwrap();
    let unknown = |name: &str, start: f64| {
        format!(
            "[[unknowns]]\nname = \"{name}\"\nunit = \"1\"\nscale = \"linear\"\nstart = {start}\nlower = -9.0\n\
             upper = 9.0\n"
        )
    };
    let condition = |name: &str, gain: f64| {
        format!(
            "[[conditions]]\nname = \"{name}\"\nvalues = {{ gain = {gain:?} }}\n\
             [[channels]]\nname = \"y\"\nunit = \"mm\"\ncondition = \"{name}\"\noffset = \"fixed\"\n\
             abscissa = {{ name = \"time\", unit = \"s\" }}\nnoise = 0.1\n\
             record = {{ file = \"{name}.csv\", at = \"time\", column = \"y\" }}\n\
             source = {{ file = \"out.csv\", column = \"y\" }}\n"
        )
    };
    let case = format!(
        "name = \"line\"\n[model]\nkind = \"command\"\nentry = \"line\"\n\
         command = [\"/bin/sh\", \"model.sh\"]\nfiles = [\"model.sh\"]\ndeadline_s = 20.0\n\
         inputs = [{{ file = \"in.txt\", braces = \"in.tpl\" }}]\noutputs = [{{ file = \"out.csv\" }}]\n\
         {}{}{}{}\
         [objective]\ncondition = {fitted}\nterms = [{{ channel = \"y\", weight = 1.0 }}]\noffset = \"free\"\n",
        unknown("a", 0.5),
        unknown("b", 0.0),
        condition("low", 1.0),
        condition("high", 2.0),
    );
    fs::write(folder.join("case.toml"), case).unwrap();
    rig.done(&["allow", "case"]);
    rig
}

/// Checks that a joint fit over two conditions determines two unknowns that a single condition leaves
/// undetermined; finite differences are combined over the conditions as the residuals are.
#[test]
fn what_one_condition_leaves_open_two_find() {
    let rig = line("[\"low\", \"high\"]");
    assert!(rig.done(&["case", "check", "case"]).contains("low + high"));
    let found = rig.object(&["calibrate", "case", "--preset", "descent", "--run", "run"]);
    for (name, truth) in [("a", 1.0), ("b", 2.0)] {
        let value = found["unknowns"][name]["value"].as_f64().unwrap();
        assert!((value - truth).abs() < 1e-4, "{name} = {value}");
    }
    // 2.5 and 4.5 are missing at the start
    let objective = &found["objective"];
    assert!((objective["recommended"].as_f64().unwrap() - 26.5).abs() < 1e-9);
    assert!(objective["optimised"].as_f64().unwrap() < 1e-8);
    // what was calibrated is never called unseen
    let report = fs::read_to_string(rig.file("run/report.html")).unwrap();
    assert!(report.contains("conditions low and high"), "the headline");
    assert!(!report.contains("took no part in the fit"));
}

#[test]
fn one_condition_alone_leaves_the_other_unmet() {
    let rig = line("\"high\"");
    let found = rig.object(&["calibrate", "case", "--preset", "descent", "--run", "run"]);
    assert!(found["objective"]["optimised"].as_f64().unwrap() < 1e-8);
    let other = &found["other_conditions"]["low"]["objective"]["optimised"];
    assert!(other.as_f64().unwrap() > 0.01, "{other}");
}

#[test]
fn conditions_of_an_objective_are_there_once_and_measured() {
    for (fitted, said) in [
        ("[\"low\", \"hihg\"]", "did you mean `high`?"),
        ("[\"low\", \"low\"]", "each condition once"),
        ("[]", "at least one condition"),
        ("3", "a name, or a list of names"),
    ] {
        let good = line("[\"low\", \"high\"]");
        let text = fs::read_to_string(good.file("case/case.toml")).unwrap();
        let text = text.replace("[\"low\", \"high\"]", fitted);
        fs::write(good.file("case/case.toml"), text).unwrap();
        let errors = good.refused(&["case", "check", "case"]);
        assert!(
            errors.contains(said) && errors.contains("condition"),
            "{fitted}: {errors}"
        );
    }
}
