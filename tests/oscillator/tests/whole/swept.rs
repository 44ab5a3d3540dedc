//! Tests of sweeps from files: a table of individuals and a grid of settings. Bad input is refused before
//! anything runs.
use crate::{
    foreign_terms,
    rig::{Rig, number},
};
use serde_json::json;
use std::fs;

pub(crate) const ROWS: &str =
    "mass,left,damping,lead\n2.1,5.6,26.0,1.7\n2.2,5.6,26.0,1.7\n2.1,5.6,26.0,1.7\n";

#[test]
fn a_table_of_individuals_comes_back_with_scores() {
    let rig = Rig::new();
    fs::write(rig.file("table.csv"), ROWS).unwrap();
    let (table, case, run) = (rig.path("table.csv"), rig.path("case"), rig.path("run"));
    let sweep = ["sweep", &table, "--case", &case, "--run", &run];
    let text = rig.run(&sweep);
    let mut lines = text.lines();
    let columns: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(
        columns[..6],
        ["mass", "left", "damping", "lead", "objective", "verdict"]
    );
    assert!(columns.contains(&"displacement.mse") && columns.contains(&"force.offset"));
    let rows: Vec<&str> = lines.collect();
    assert_eq!(rows.len(), 3);
    assert!(rows[0].starts_with("2.1,5.6,26,1.7,") && rows[0].contains(",complete,"));
    assert!(rows[0] == rows[2] && rows[0] != rows[1]);
    assert_eq!(fs::read_to_string(rig.file("run/sweep.csv")).unwrap(), text);
    let object = rig.json(&sweep);
    let first = &object["individuals"][0];
    assert_eq!(
        (&first["genes"]["mass"], &first["complete"]),
        (&json!(2.1), &json!(true))
    );
    let cell: f64 = rows[0].split(',').nth(4).unwrap().parse().unwrap();
    assert_eq!(number(&first["objective"]).to_bits(), cell.to_bits());
    assert!(number(&first["channels"]["displacement"]["mse"]) > 0.0);
    // the same as line by line
    let line = json!({"id": 1, "genes": first["genes"]}).to_string();
    let other = rig.path("other");
    let (lines, _) = rig.run_with_input(&["evaluate", "CASE", "--run", &other], &line);
    assert_eq!(lines[0]["objective"], first["objective"]);
    foreign_terms::check_folder(run.as_ref());
    // another table in the same folder is another run
    fs::write(rig.file("table.csv"), ROWS.replace("2.2", "2.3")).unwrap();
    assert!(
        rig.refused(&sweep)
            .contains("its file holds something else")
    );
}

#[test]
fn a_table_that_cannot_be_scored_is_refused_by_row_and_column() {
    let rig = Rig::new();
    let (table, case, run) = (rig.path("table.csv"), rig.path("case"), rig.path("run"));
    let refused = |text: &str, said: &[&str]| {
        fs::write(rig.file("table.csv"), text).unwrap();
        let error = rig.refused(&["sweep", &table, "--case", &case, "--run", &run]);
        assert!(error.contains("table.csv"), "{error}");
        assert!(
            said.iter().all(|said| error.contains(said)),
            "{said:?}: {error}"
        );
        assert!(!rig.file("run").exists(), "nothing is begun");
    };
    refused("", &["empty"]);
    refused("mass,left,damping,lead\n", &["no rows"]);
    refused(
        &ROWS.replace("lead", "laed"),
        &["column `lead` is missing", "did you mean `laed`?"],
    );
    refused("mass,left,damping\n2,6,30\n", &["column `lead` is missing"]);
    refused(
        "mass,left,damping,lead,colour\n2,6,30,1,4\n",
        &[
            "row 1, column `colour` is not known",
            "mass, left, damping, lead",
        ],
    );
    refused(
        &ROWS.replace("2.2,", "9e9,"),
        &["row 3, column `mass`: 9e9", "allowed: 5e-1 to 8e0 kg"],
    );
    refused(
        &ROWS.replace("2.2,5.6", "2.2,NaN"),
        &["row 3, column `left`: `NaN`", "a finite number"],
    );
    refused(
        &ROWS.replace("2.2,5.6", "2.2"),
        &["row 3", "a row of 3 cells"],
    );
    let error = rig.refused(&["sweep", &table]);
    assert!(
        error.contains("no case folder is given") && error.contains("--case"),
        "{error}"
    );
}

const GRID: &str = r#"
case = "case"
seeds = [1, 2]
evaluations = 40
[set]
crossover_trials = 2
[grid]
population = [8, 16]
encoding = ["binary", "gray"]
"#;

#[test]
fn a_grid_runs_every_combination() {
    let rig = Rig::new();
    fs::write(rig.file("grid.toml"), GRID).unwrap();
    let (grid, run) = (rig.path("grid.toml"), rig.path("run"));
    let object = rig.json(&["sweep", &grid, "--run", &run]);
    let runs = object["runs"].as_array().unwrap();
    assert_eq!(runs.len(), 8);
    let first = json!({"encoding": "binary", "population": 8});
    assert_eq!((&runs[0]["levels"], &runs[0]["seed"]), (&first, &json!(1)));
    assert!(runs.iter().all(|run| run["evaluations"] == 40));
    let text = rig.run(&["sweep", &grid, "--run", &run]);
    assert!(text.contains("encoding gray, population 16"), "{text}");
    let table = fs::read_to_string(rig.file("run/sweep.csv")).unwrap();
    assert!(table.starts_with("encoding,population,seed,objective,evaluations\nbinary,8,1,"));
    foreign_terms::check_folder(run.as_ref());
}

#[test]
fn a_grid_that_makes_no_searches_is_refused() {
    let rig = Rig::new();
    let (grid, run) = (rig.path("grid.toml"), rig.path("run"));
    let refused = |from: &str, to: &str, said: &[&str]| {
        assert!(GRID.contains(from));
        fs::write(rig.file("grid.toml"), GRID.replace(from, to)).unwrap();
        let error = rig.refused(&["sweep", &grid, "--run", &run]);
        assert!(error.contains("grid.toml"), "{error}");
        assert!(
            said.iter().all(|said| error.contains(said)),
            "{said:?}: {error}"
        );
        assert!(!rig.file("run").exists(), "nothing is begun");
    };
    refused("seeds", "sedes", &["sedes"]);
    refused("[1, 2]", "[1, 1]", &["`seeds` = [1, 1]", "different seeds"]);
    refused("[8, 16]", "[]", &["grid.population", "one value at least"]);
    refused("[8, 16]", "[8, 2]", &["factor population", "4 to 100000"]);
    refused(
        "[8, 16]",
        "[8, [9]]",
        &["grid.population[1]", "a number, a word"],
    );
    refused("population", "populatoin", &["did you mean `population`?"]);
    refused(
        "seeds",
        "preset = \"papier\"\nseeds",
        &["`preset` = papier", "paper"],
    );
    refused("= 40", "= 0", &["`evaluations` = 0"]);
    refused("case = \"case\"", "", &["no case folder is given"]);
}
