//! Tests of the allow list: the machine alone decides which external programs may be started.
use crate::rig::Rig;
use std::fs;

const GOOD: &str = "printf 'y\\n1\\n2\\n4\\n' > out.csv\n";

#[test]
fn nothing_is_started_that_was_not_allowed() {
    let rig = Rig::new();
    rig.shell_case(GOOD, "");
    let said = rig.refused(&["simulate", "case"]);
    assert!(
        said.contains("does not allow") && said.contains("horsehead allow"),
        "{said}"
    );
    let shown = rig.object(&["allow", "case", "--dry-run"]);
    assert_eq!(
        (&shown["entry"], &shown["written"]),
        (&"shell".into(), &false.into())
    );
    assert!(!rig.file("allow.toml").exists());
    rig.done(&["allow", "case"]);
    rig.done(&["simulate", "case", "--out", "shown"]);
    // other files are another program
    fs::write(
        rig.file("case/model.sh"),
        "echo mischief > mischief\n".to_owned() + GOOD,
    )
    .unwrap();
    let said = rig.refused(&["simulate", "case"]);
    assert!(said.contains("files are not those"), "{said}");
    rig.done(&["allow", "case"]);
    rig.done(&["simulate", "case", "--out", "shown"]);
    fs::write(rig.file("allow.toml"), "[entry.shell]\nprogramme = 1\n").unwrap();
    let said = rig.refused(&["simulate", "case"]);
    assert!(
        said.contains("allow.toml") && said.contains("programme"),
        "{said}"
    );
}

#[test]
fn an_entry_of_another_case_is_not_replaced_in_silence() {
    let rig = Rig::new();
    rig.shell_case(GOOD, "");
    rig.done(&["allow", "case"]);
    let path = rig.file("case/case.toml");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(
        &path,
        text.replace("\"model.sh\"]\nfiles", "\"model.sh\", \"again\"]\nfiles"),
    )
    .unwrap();
    let said = rig.refused(&["allow", "case"]);
    for words in [
        "entry `shell` starts `/bin/sh model.sh`",
        "wants `/bin/sh model.sh again`",
        "--replace",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    assert!(
        !fs::read_to_string(rig.file("allow.toml"))
            .unwrap()
            .contains("again")
    );
    rig.done(&["allow", "case", "--replace"]);
    // other files under the same name are worth a word
    fs::write(rig.file("case/model.sh"), "# another\n".to_owned() + GOOD).unwrap();
    let output = rig.run(&["allow", "case"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.success() && said.contains("was allowed for other files"),
        "{said}"
    );
    // and a program that there is not is no program
    fs::write(&path, text.replace("\"/bin/sh\"", "\"pyhton3\"")).unwrap();
    let said = rig.refused(&["allow", "case"]);
    for words in ["`model.command` = \"pyhton3\"", "there is no such program"] {
        assert!(said.contains(words), "{words}: {said}");
    }
}

#[test]
fn what_a_case_has_wrong_is_said_by_file_and_field() {
    let rig = Rig::new();
    for (from, to, words) in [
        (
            "files = [\"model.sh\"]",
            "files = [\"../model.sh\"]",
            "model.files",
        ),
        ("files = [\"model.sh\"]", "files = [\"nowhere\"]", "nowhere"),
        ("deadline_s = 20.0", "deadline_s = 0.0", "deadline_s"),
        (
            "braces = \"in.tpl\"",
            "braces = \"in.tpl\", dakota = \"json\"",
            "exactly one",
        ),
        (
            "column = \"y\" }\n[obj",
            "column = \"y\", file2 = \"z\" }\n[obj",
            "file2",
        ),
        (
            "file = \"out.csv\", column",
            "file = \"out.cvs\", column",
            "did you mean `out.csv`",
        ),
        ("entry = \"shell\"", "entry = \"a b\"", "model.entry"),
        (
            "[model]\n",
            "[model]\nreference_tolerance = -1.0\n",
            "model.reference_tolerance",
        ),
        (
            "[model]\n",
            "[model]\nrepeatable = true\nreference_tolerance = 0.1\n",
            "beside `repeatable = true`",
        ),
        (
            "[model]\n",
            "[model]\nverdicts = { 0 = \"fine\" }\n",
            "verdicts",
        ),
    ] {
        rig.shell_case(GOOD, "");
        let path = rig.file("case/case.toml");
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{from}");
        fs::write(&path, text.replacen(from, to, 1)).unwrap();
        let said = rig.refused(&["case", "check", "case"]);
        assert!(
            said.contains(words) && said.contains("case.toml"),
            "{words}: {said}"
        );
    }
}

/// Checks that a misspelt field of a template is shown where it stands, and not in `case.toml`.
#[test]
fn a_misspelt_field_is_shown_in_its_template() {
    let rig = Rig::new();
    rig.shell_case(GOOD, "");
    fs::write(rig.file("case/in.tpl"), "xx 1\nx {xx}\n").unwrap();
    let said = rig.refused(&["case", "check", "case"]);
    for words in [
        "in.tpl: `line 2` = \"xx\"",
        "2 | x {xx}",
        "  |    ^^",
        "did you mean `x`?",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    assert!(!said.contains("case.toml"), "{said}");
}

#[test]
fn a_record_beyond_the_curve_that_the_program_left_in_the_folder_is_refused() {
    let rig = Rig::new();
    rig.shell_case(GOOD, "");
    let path = rig.file("case/case.toml");
    let text = fs::read_to_string(&path).unwrap();
    let along = "column = \"y\", at = \"t\" }\n[obj";
    fs::write(&path, text.replacen("column = \"y\" }\n[obj", along, 1)).unwrap();
    // the record goes from 0 to 2
    let left = rig.file("case/out.csv");
    fs::write(&left, "t,y\n0,1\n1.5,2\n").unwrap();
    let said = rig.refused(&["case", "check", "case"]);
    for words in [
        "channels",
        "from 0 to 2",
        "from 0 to 1.5",
        "out.csv",
        "shorten the record",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    fs::write(&left, "t,y\n0,1\n3,2\n").unwrap();
    rig.done(&["case", "check", "case"]);
}

/// Checks that a machine whose program gives different numbers for the same values is not admitted to the
/// run, and that one within the tolerance of the case is.
#[test]
fn machines_are_compared_by_a_reference_run_within_the_case_s_tolerance() {
    // whoever is not the first gives a hundredth more
    let program = "ln -s $PPID ../../first 2>/dev/null\n[ $(readlink ../../first) = $PPID ] && v=4.00 || v=4.04\n\
                   printf \"y\\n1\\n2\\n$v\\n\" > out.csv\n";
    let told = |tolerance: &str| {
        let rig = Rig::shell(program, tolerance);
        let words = "calibrate case --preset random --set points=20 --run run";
        let words: Vec<&str> = words.split(' ').collect();
        let output = rig.run(&words);
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{errors}");
        errors
    };
    let refused = told("reference_tolerance = 0.001");
    assert!(
        refused.contains("where this run's is 4") && refused.contains("reference_tolerance"),
        "{refused}"
    );
    for accepted in ["reference_tolerance = 0.05", ""] {
        let said = told(accepted);
        assert!(
            !said.contains("refused") && !said.contains("proof"),
            "{said}"
        );
    }
}
