//! Tests of common mistakes at the command line: each answer must name the fault and the remedy. Faults in
//! the files of a case are tested in `case_errors`.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of tests: a command that cannot be run or read has failed"
)]
mod folder;
mod records;

use folder::{Mistake, TestFolder};
use std::{fs, process::Command};

const SHORT: &str = "[[effects]]\nid = \"pivot_frictoin\"\nparameters = { moment = { value = 9.0, unit = \"N.m\" } }";

const MISTAKES: &[Mistake] = &[
    (
        "the file in place of the folder",
        |_| {},
        "case check case/case.toml",
        0,
        &["CYJS10-5-37HB"],
    ),
    (
        "no such case",
        |_| {},
        "case check casse",
        2,
        &["casse/case.toml"],
    ),
    (
        "an effect misspelt",
        |d| d.effect(SHORT),
        "case check case",
        2,
        &[
            "case.toml: `effects[0].id` = \"pivot_frictoin\"",
            "`pivot_friction`",
        ],
    ),
    (
        "a parameter of an effect misspelt, another one outside its range",
        |d| {
            d.effect(
                "[[effects]]\nid = \"pivot_friction\"\nparameters = { momnet = { value = 9.0, unit = \"N.m\" }, \
                 creep = { value = -4.0, unit = \"rad/s\" } }",
            );
        },
        "case check case",
        2,
        &[
            "2 faults",
            "`effects[0].parameters.momnet` = 9",
            "`moment`",
            "`effects[0].parameters.creep.value` = -4",
        ],
    ),
    (
        "an effect misspelt, simulated",
        |d| d.effect(SHORT),
        "simulate case",
        2,
        &["effects", "pivot_frictoin", "`horsehead case check CASE`"],
    ),
    (
        "a simulation that fails",
        |d| d.replace("case/recommended.toml", "value = 3.14e8", "value = 3.14e4"),
        "simulate case --genes case/recommended.toml",
        1,
        &["simulation", "--genes FILE"],
    ),
    (
        "no figures asked for",
        |_| {},
        "simulate case",
        0,
        &["add --out DIR"],
    ),
    (
        "doctor without an address",
        |_| {},
        "doctor",
        0,
        &["program      ok", "port         ok"],
    ),
    (
        "a count with a fraction",
        |d| {
            d.replace(
                "case/case.toml",
                "back_cylinders = 72",
                "back_cylinders = 72.5",
            );
        },
        "case check case",
        2,
        &["case.toml", "72.5"],
    ),
    (
        "a seed in words",
        |_| {},
        "calibrate case --seed x",
        2,
        &["--seed", "'x'"],
    ),
    (
        "a preset misspelt",
        |_| {},
        "calibrate case --preset quik",
        2,
        &["'quik'", "quick"],
    ),
    (
        "a setting misspelt",
        |_| {},
        "calibrate case --set pionts=4",
        2,
        &["pionts", "points"],
    ),
    (
        "a condition that there is not",
        |_| {},
        "simulate case --condition 6rpm",
        2,
        &["6rpm", "5rpm, 4rpm"],
    ),
    (
        "a gene file that there is not",
        |_| {},
        "simulate case --genes best.toml",
        2,
        &["best.toml"],
    ),
    (
        "a derivative by what there is not",
        |_| {},
        "simulate case --derivatives kb9",
        2,
        &["`kb9`", "kb1, kb23"],
    ),
    (
        "a derivative by a parameter that an effect has not",
        |_| {},
        "simulate case --derivatives pivot_friction.moemnt",
        2,
        &["moemnt", "`pivot_friction`"],
    ),
    (
        "Slurm's nodes in letters",
        |_| {},
        "workers up --connect tcp/127.0.0.1:7447 --slurm nodes=abc",
        2,
        &["nodes=abc", "nodes=4"],
    ),
    (
        "a table of another case",
        |d| d.write("table.csv", "k,c\n1,2\n"),
        "sweep table.csv --case case",
        2,
        &["table.csv", "`kb1`"],
    ),
    (
        "a table whose cells lie outside the bounds",
        |d| d.write("table.csv", &table("kb1", "1")),
        "sweep table.csv --case case",
        2,
        &["table.csv", "row 2", "`kb1`", "3.14e4 to 3.14e12 N/m"],
    ),
    (
        "a table that is no table",
        |d| d.write("table.txt", "1 2 3\n"),
        "sweep table.txt --case case",
        2,
        &["neither a grid nor a table"],
    ),
    (
        "a run that there is not",
        |_| {},
        "report runs/nowhere",
        2,
        &["runs/nowhere"],
    ),
    (
        "a folder in place of a run",
        |_| {},
        "report case",
        2,
        &["run.json"],
    ),
    (
        "allowing a case that needs no permission",
        |_| {},
        "allow case",
        2,
        &["`model.kind` = \"dhh\""],
    ),
    (
        "no workers at all",
        |_| {},
        "calibrate case --workers 0",
        2,
        &["--workers 2, or --listen"],
    ),
    (
        "records that there are not",
        |_| {},
        "calibrate case --measured tests/of/march",
        2,
        &["--measured", "tests/of/march"],
    ),
    (
        "an address without a port",
        |_| {},
        "calibrate case --listen 127.0.0.1",
        2,
        &["127.0.0.1", "7447"],
    ),
    (
        "a folder that exists already",
        |_| {},
        "case new case",
        2,
        &["case/case.toml"],
    ),
    (
        "a new case where nothing can be written",
        |_| {},
        "case new /proc/unit",
        2,
        &["/proc/unit/case.toml"],
    ),
    (
        "a report where nothing can be written",
        |_| {},
        "simulate case --out /proc/shown",
        2,
        &["--out DIR"],
    ),
    (
        "a run where nothing can be written",
        |_| {},
        "calibrate case --run /proc/run",
        2,
        &["--run DIR"],
    ),
    (
        "an unknown in another unit",
        |d| {
            d.replace(
                "case/recommended.toml",
                "value = 3.14e8, unit = \"N/m\"",
                "value = 3.14e5, unit = \"N/mm\"",
            );
        },
        "simulate case --genes case/recommended.toml",
        2,
        &["recommended.toml: `kb1.unit` = \"N/mm\"", "`N/m`", "1000"],
    ),
    (
        "a length in inches",
        |d| d.replace("case/case.toml", "radius_m = 1.900", "radius_in = 74.8"),
        "case check case",
        2,
        &["`radius_in`", "`radius_m`", "0.0254"],
    ),
    (
        "a table with semicolons and decimal commas",
        |d| {
            let text = table("kb1", "3.2e8").replace(',', ";").replace('.', ",");
            d.write("table.csv", &text);
        },
        "sweep table.csv --case case --run swept",
        0,
        &["320000000"],
    ),
    (
        "a port that is none",
        |_| {},
        "calibrate case --listen tcp/127.0.0.1:99999",
        2,
        &["99999"],
    ),
    (
        "two records of one gauge",
        |d| {
            d.record(|row, cells| {
                if row == 0 {
                    cells[4] = cells[2].clone();
                }
            });
        },
        "case check case",
        2,
        &["test_5rpm.csv.gz", "`stress_1_mpa`"],
    ),
    (
        "a record of another speed",
        |d| {
            let at = |speed| d.path(&format!("case/measured/test_{speed}rpm.csv.gz"));
            fs::copy(at(4), at(5)).unwrap();
        },
        "calibrate case",
        2,
        &["test_5rpm.csv.gz", "4.001 /min", "speed_rpm = 5"],
    ),
    (
        "resuming what is no run",
        |d| fs::create_dir(d.path("mine")).unwrap(),
        "export mine",
        2,
        &["mine is no run folder", "horsehead calibrate CASE"],
    ),
    (
        "an effect to leave out that nobody knows",
        |_| {},
        "diagnose case --without friction",
        2,
        &["`friction`", "pivot_friction"],
    ),
];

/// Returns a CSV table of one individual at the recommended values, except for the unknown `name`.
fn table(name: &str, value: &str) -> String {
    let mut cells = [
        ("kb1", "3.14e8"),
        ("kb23", "1.26e8"),
        ("kb4", "137"),
        ("kb56", "137"),
        ("cb1", "400"),
        ("cb23", "400"),
        ("cb4", "0.4"),
        ("cb56", "0.4"),
        ("kc", "1e6"),
        ("cc", "100"),
    ];
    for (own, cell) in &mut cells {
        if *own == name {
            *cell = value;
        }
    }
    let names = cells.map(|(name, _)| name).join(",");
    format!("{names}\n{}\n", cells.map(|(_, cell)| cell).join(","))
}

#[test]
fn every_mistake_is_answered_with_what_to_do() {
    let mut wrong = Vec::new();
    for (name, prepare, command, code, words) in MISTAKES.iter().chain(records::RECORDS) {
        let desk = TestFolder::new();
        prepare(&desk);
        let (ended, said) = desk.run(command);
        let missing: Vec<&&str> = words.iter().filter(|part| !said.contains(**part)).collect();
        if ended != *code || !missing.is_empty() {
            wrong.push(format!(
                "{name}: `{command}` ends with {ended}, not {code}; no {missing:?} in\n{said}"
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// Checks that a run folder is refused for a case edited since the run began, that the message names the
/// change, and that the command it suggests works.
#[test]
fn a_case_that_was_edited_after_its_run_begins_another_one() {
    let desk = TestFolder::new();
    desk.write("table.csv", &table("kb1", "3.2e8"));
    let sweep = "sweep table.csv --case case --run first";
    assert_eq!(desk.run(sweep).0, 0);
    desk.replace(
        "case/case.toml",
        "recommended = 3.14e8",
        "recommended = 3.15e8",
    );
    let (code, said) = desk.run(sweep);
    let words = "the case has changed since first was begun: kb1 starts at 3.15e8, not 3.14e8";
    assert!(code == 2 && said.contains(words), "{said}");
    let advised = said.lines().find(|line| line.contains("--run first-2"));
    let advised = advised.unwrap_or_else(|| panic!("no command in\n{said}"));
    let advised = advised.trim().trim_start_matches("horsehead ").to_owned();
    let (code, said) = desk.run(&advised);
    assert_eq!(code, 0, "{advised}: {said}");
}

/// Checks that tables written by `sweep` and `export` can be read by `sweep` again, although their column
/// names carry units and further columns hold the results.
#[test]
fn tables_that_were_written_are_read() {
    let desk = TestFolder::new();
    desk.write("table.csv", &table("kb1", "3.2e8"));
    let (code, said) = desk.run("sweep table.csv --case case --run first");
    assert_eq!(code, 0, "{said}");
    let (code, said) =
        desk.run("calibrate case --preset latin-hypercube --set points=3 --run second");
    assert_eq!(code, 0, "{said}");
    // three points are no fit, and that is said with the command that finds out
    for words in [
        "The fit leaves ",
        " times the noise at gauge ",
        "`horsehead diagnose second` finds out what",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let (code, said) = desk.run("export second --format csv");
    assert_eq!(code, 0, "{said}");
    for (written, value) in [
        ("first/sweep.csv", "320000000"),
        ("second/csv/evaluations.csv", "314000000"),
    ] {
        let again = format!("sweep {written} --case case --run of-{}", written.len());
        let (code, said) = desk.run(&again);
        assert_eq!(code, 0, "{written}: {said}");
        assert!(said.contains(value), "{written}: {said}");
    }
}

/// Checks that the output of `case check` ends with exactly one newline, so that the shell prompt starts on a
/// line of its own.
#[test]
fn a_check_ends_its_last_line() {
    let desk = TestFolder::new();
    let output = Command::new(env!("CARGO_BIN_EXE_horsehead"))
        .args(["case", "check", "case"])
        .current_dir(desk.path(""))
        .output()
        .unwrap();
    assert!(output.stdout.ends_with(b"\n") && !output.stdout.ends_with(b"\n\n"));
}
