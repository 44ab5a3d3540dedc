//! Checks that every fault of a case produces one error that names the file, the field and a remedy.
#![expect(
    clippy::unwrap_used,
    reason = "a test that cannot prepare its case has failed"
)]
mod back_head;
mod card;
mod case_file;
mod record;
mod spoilt;
mod twins;

use case::pumping_unit::load_head;
use case::{self, Overrides};
use protocol::{case::Scale, pumping_unit::Machine};
use spoilt::{CARD, Copy, MODES, RECORD, SHEET, TOML, assert_each_is_named, scaled};
use std::fs;

#[test]
fn every_fault_of_the_case_file_is_named() {
    assert_each_is_named(case_file::FAULTS, Copy::without_mesh);
}

#[test]
fn every_fault_of_a_load_card_is_named() {
    assert_each_is_named(card::FAULTS, Copy::without_mesh);
}

#[test]
fn every_fault_of_a_record_is_named() {
    assert_each_is_named(record::FAULTS, Copy::without_mesh);
}

#[test]
fn every_fault_of_the_back_head_is_named() {
    assert_each_is_named(back_head::FAULTS, Copy::new);
}

#[test]
fn every_fault_of_twin_ropes_is_named() {
    assert_each_is_named(twins::FAULTS, Copy::new);
}

/// Checks that the folder of `--measured` may hold records of only some conditions: the others keep their
/// load card and have no record.
#[test]
fn another_test_need_not_repeat_every_condition() {
    let copy = Copy::new();
    let other = copy.path("other");
    fs::create_dir(&other).unwrap();
    for file in ["card_5rpm.csv", "test_5rpm.csv.gz", "test_5rpm.toml"] {
        fs::copy(copy.path(&format!("measured/{file}")), other.join(file)).unwrap();
    }
    let load = |measured| case::load_with_notes(copy.folder.path(), &Overrides { measured });
    let (own, part) = (load(None).unwrap(), load(Some(other.clone())).unwrap());
    let [calibrated, _] = &part.case.conditions[..] else {
        panic!("two conditions");
    };
    assert_eq!(*calibrated, own.case.conditions[0]);
    let card = |case| Machine::of(case).unwrap().conditions.swap_remove(1).card;
    assert_eq!(card(&part.case), card(&own.case));
    assert_eq!((part.case.is_measured(1), part.cycles.len()), (false, 1));
    let said = "test_4rpm.csv.gz does not exist: condition `4rpm` has no record";
    assert!(
        part.notes
            .iter()
            .any(|note| note.to_string().contains(said))
    );
    // the calibrated condition must be there
    fs::remove_file(other.join("test_5rpm.csv.gz")).unwrap();
    let message = load(Some(other)).unwrap_err().to_string();
    assert!(
        message.contains("other/test_5rpm.csv.gz: no such file"),
        "{message}"
    );
}

#[test]
fn another_test_of_the_same_machine_replaces_the_records() {
    let copy = Copy::new();
    let other = copy.path("other");
    fs::create_dir(&other).unwrap();
    let overrides = Overrides {
        measured: Some(other.clone()),
    };
    let load = || case::load(copy.folder.path(), &overrides);
    let message = load().unwrap_err().to_string();
    assert!(
        message.contains("other/card_5rpm.csv: no such file"),
        "{message}"
    );
    for file in [
        "card_5rpm.csv",
        "test_5rpm.csv.gz",
        "test_5rpm.toml",
        "card_4rpm.csv",
        "test_4rpm.csv.gz",
    ] {
        fs::copy(copy.path(&format!("measured/{file}")), other.join(file)).unwrap();
    }
    let message = load().unwrap_err().to_string();
    assert!(
        message.contains("other/test_4rpm.toml: no such file"),
        "{message}"
    );
    fs::copy(
        copy.path("measured/test_4rpm.toml"),
        other.join("test_4rpm.toml"),
    )
    .unwrap();
    // the case's own record is doubled, the other folder's is not
    copy.lines(RECORD, |at, line| scaled(at, line, &[2], 2.0));
    let plain = case::load(copy.folder.path(), &Overrides::default()).unwrap();
    let replaced = load().unwrap();
    let first = |case: &protocol::case::Case| case.channels[0].record.as_ref().unwrap().mean[7];
    assert!((first(&plain) - 2.0 * first(&replaced)).abs() < 1e-9);
    assert_eq!(replaced.conditions[1], plain.conditions[1]);
}

/// Checks that an objective may sum several conditions with weights, and that a gauge may be missing from the
/// record of one of them.
#[test]
fn an_objective_may_sum_several_conditions_with_weights() {
    let copy = Copy::new();
    let both = "condition = [\"5rpm\", { name = \"4rpm\", weight = 0.5 }]";
    copy.replace(TOML, "condition = \"5rpm\"", both);
    let load = || case::load_with_notes(copy.folder.path(), &Overrides::default());
    let loaded = load().unwrap();
    let weights = loaded.case.objective.weighted_conditions();
    let weights: Vec<(usize, f64)> = weights.map(|one| (one.condition, one.weight)).collect();
    assert_eq!(weights, [(0, 1.0), (1, 0.5)]);
    let summary = case::check(copy.folder.path(), &Overrides::default());
    let summary = summary.unwrap().text;
    assert!(
        summary.contains("objective   5rpm + 0.5 x 4rpm: "),
        "{summary}"
    );

    let record = "measured/test_4rpm.csv.gz";
    copy.lines(record, |_, line| {
        Some(line.replace("stress_3_mpa", "other"))
    });
    let error = load().unwrap_err().to_string();
    assert!(error.contains("`objective.gauges[1].gauge` = 3"), "{error}");
    copy.replace(
        TOML,
        "{ gauge = 3, weight = 1.0 }",
        "{ gauge = 3, weight = 1.0, optional = true }",
    );
    let loaded = load().unwrap();
    assert_eq!(loaded.case.objective.terms.len(), 2);
    let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
    let lacks = "the record of condition `4rpm` lacks gauge_3: it is compared over gauge_1";
    assert!(notes.iter().any(|note| note.contains(lacks)), "{notes:?}");
}

/// Checks that a case with load cards alone can be simulated, and that operations that need a record name the
/// missing field.
#[test]
fn a_case_may_have_load_cards_alone() {
    let copy = Copy::new();
    let text = fs::read_to_string(copy.path(TOML)).unwrap();
    let bare = text.lines().filter(|line| !line.starts_with("record_file"));
    let bare = bare.collect::<Vec<_>>().join("\n");
    for file in [
        RECORD,
        SHEET,
        "measured/test_4rpm.csv.gz",
        "measured/test_4rpm.toml",
    ] {
        fs::remove_file(copy.path(file)).unwrap();
    }
    fs::write(copy.path(TOML), bare).unwrap();
    for has_objective in [true, false] {
        if !has_objective {
            copy.cut(TOML, "[objective]", "[run]");
        }
        let case = case::load(copy.folder.path(), &Overrides::default()).unwrap();
        assert!(case.channels.iter().all(|channel| channel.record.is_none()));
        assert_eq!(case.objective.condition, 0);
        let summary = case::check(copy.folder.path(), &Overrides::default())
            .unwrap()
            .text;
        assert_eq!(
            summary.contains("no [objective]: the case is simulated only"),
            !has_objective,
            "{summary}"
        );
        assert_eq!(
            summary.matches("no record: simulated only").count(),
            2,
            "{summary}"
        );
        let refused = case::require_record(copy.folder.path(), &case, 0);
        let message = refused.unwrap_err().to_string();
        for expected in [
            "case.toml: `conditions[0].record_file` = absent",
            "a record of condition `5rpm`",
            "help: add record_file = \"measured/test_5rpm.csv.gz\"",
        ] {
            assert!(message.contains(expected), "no `{expected}` in\n{message}");
        }
    }
    let with = Copy::new();
    let case = case::load(with.folder.path(), &Overrides::default()).unwrap();
    case::require_record(with.folder.path(), &case, 0).unwrap();
}

#[test]
fn what_is_doubtful_is_a_note() {
    let copy = Copy::new();
    copy.replace(SHEET, "samples_recorded = 5970", "");
    copy.replace(
        SHEET,
        "revolutions = 5",
        "revolutions = 5\noperator = \"night shift\"",
    );
    // 2.2 revolutions are left, and one burst of 0.3 s is lost
    copy.lines(RECORD, |at, line| {
        (at < 2640 && !(700..730).contains(&at)).then(|| line.to_owned())
    });
    let loaded = case::load_with_notes(copy.folder.path(), &Overrides::default()).unwrap();
    let record = loaded.case.channels[0].record.as_ref().unwrap();
    assert_eq!(record.cycles, 2);
    let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
    let notes = notes.join("\n");
    for expected in [
        "test_5rpm.toml: `operator` is not used",
        "the time column lacks 33 samples, the data sheet says 30",
        "2 whole cycles: the noise model is rough",
        "grid angles lack a cycle",
    ] {
        assert!(notes.contains(expected), "no `{expected}` in\n{notes}");
    }

    copy.lines(RECORD, |at, line| (at < 1300).then(|| line.to_owned()));
    // the burst is in the only cycle now: nothing stands for it
    let message = copy.error().to_string();
    assert!(message.contains("on every cycle"), "{message}");
}

/// Checks that a misspelt gauge column is an error unless the case marks the gauge as optional, so that the
/// objective does not change unnoticed.
#[test]
fn an_objective_loses_a_gauge_only_where_the_case_says_so() {
    let copy = Copy::new();
    copy.lines(RECORD, |at, line| {
        let renamed = line.replace("stress_1_mpa", "stress_upper");
        Some(if at == 1 { renamed } else { line.into() })
    });
    copy.error();
    copy.replace(
        TOML,
        "gauge = 1, weight = 1.0",
        "gauge = 1, weight = 1.0, optional = true",
    );
    let loaded = case::load_with_notes(copy.folder.path(), &Overrides::default()).unwrap();
    let terms = loaded.case.objective.terms.iter();
    let terms: Vec<&str> = terms.map(|term| &*term.channel).collect();
    assert_eq!(terms, ["gauge_3"]);
    let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
    let notes = notes.join("\n");
    for expected in [
        "column `stress_upper` is not used: did you mean `stress_1_mpa`?",
        "the record lacks gauge_1: the objective is taken over gauge_3",
    ] {
        assert!(notes.contains(expected), "no `{expected}` in\n{notes}");
    }
    // without any gauge of the objective there is nothing to minimise
    copy.replace(
        TOML,
        "gauge = 3, weight = 1.0",
        "gauge = 1, weight = 1.0, optional = true",
    );
    copy.replace(
        TOML,
        "gauges = [{ gauge = 1, weight = 1.0, optional = true }, ",
        "gauges = [",
    );
    let message = copy.error().to_string();
    assert!(
        message.contains("`objective.gauges[0].gauge` = 1"),
        "{message}"
    );
}

/// Checks that tables from spreadsheets are read: semicolons, decimal commas, UTF-16.
#[test]
fn files_of_other_programs_are_read() {
    let copy = Copy::new();
    let plain = case::load(copy.folder.path(), &Overrides::default()).unwrap();
    copy.lines(RECORD, |_, line| {
        Some(line.replace(',', ";").replace('.', ","))
    });
    copy.lines(CARD, |_, line| Some(line.replace(',', "\t")));
    for (file, units) in [
        (CARD, u16::to_le_bytes as fn(u16) -> [u8; 2]),
        (TOML, u16::to_be_bytes),
        (SHEET, u16::to_le_bytes),
    ] {
        let text = fs::read_to_string(copy.path(file)).unwrap();
        let text = format!("\u{feff}{text}");
        let bytes: Vec<u8> = text.encode_utf16().flat_map(units).collect();
        fs::write(copy.path(file), bytes).unwrap();
    }
    let read = case::load(copy.folder.path(), &Overrides::default()).unwrap();
    assert_eq!(read, plain);
}

#[test]
fn one_cycle_has_no_spread() {
    let copy = Copy::new();
    copy.replace(SHEET, "samples_recorded = 5970", "");
    copy.lines(RECORD, |_, line| {
        let time = line.split(',').next().unwrap().parse::<f64>();
        time.map_or(true, |time| (23.0..37.5).contains(&time))
            .then(|| line.to_owned())
    });
    let loaded = case::load_with_notes(copy.folder.path(), &Overrides::default()).unwrap();
    for (_, _, record) in loaded.case.measured(0) {
        assert_eq!((record.cycles, &record.spread), (1, &vec![0.0; 720]));
    }
    let text = format!("{:?}", loaded.notes);
    assert!(text.contains("one whole cycle only"), "{text}");
}

/// Checks that an effect parameter with a `search` interval becomes an unknown, listed after the
/// coefficients, and that one without leaves the unknowns unchanged. Removing an effect that a diagnosis has
/// added also removes its unknowns.
#[test]
fn a_parameter_with_an_interval_to_search_is_a_gene() {
    let copy = Copy::new();
    let text = fs::read_to_string(copy.path(TOML)).unwrap();
    let with = |lines: &str| {
        fs::write(copy.path(TOML), &text).unwrap();
        copy.effect(lines);
        case::load_with_notes(copy.folder.path(), &Overrides::default()).unwrap()
    };
    let moment = |more: &str| {
        format!(
            "parameters = {{ moment = {{ value = 9.0, unit = \"N.m\"{more} }}, \
             creep = {{ value = 0.002, unit = \"rad/s\" }} }}\n\
             provenance = {{ dataset = \"this one\" }}"
        )
    };
    let fixed = with(&moment(""));
    assert_eq!(fixed.case.unknowns.len(), 10);
    let searched = with(&moment(", search = [-1.0, 20.0]"));
    let [.., gene] = searched.case.unknowns.as_slice() else {
        unreachable!("no genes");
    };
    assert_eq!(searched.case.unknowns.len(), 11);
    assert_eq!(gene.name, "pivot_friction.moment");
    assert_eq!((gene.unit.as_str(), gene.scale), ("N.m", Scale::Linear));
    assert_eq!((gene.lower, gene.start, gene.upper), (-1.0, 9.0, 20.0));
    assert_eq!(searched.case.effects, fixed.case.effects);
    let other = searched.clone().without_effects_from("another one");
    assert_eq!(other, searched);
    let without = searched.without_effects_from("this one").case;
    assert_eq!(without.unknowns, fixed.case.unknowns);
    assert!(without.effects.is_empty());
}

/// Checks that Eq. 3 and Eq. 5 may replace recommended values and are evaluated in the units of the genes.
#[test]
fn recommended_values_by_formula() {
    let copy = Copy::new();
    for (number, formula) in [
        (
            "kb1  = { recommended = 3.14e8,",
            "kb1  = { recommended = \"eq3\",",
        ),
        (
            "kb56 = { recommended = 137.0,",
            "kb56 = { recommended = \"eq3\",",
        ),
        (
            "kc   = { recommended = 1.00e6, lower = 1.00e2, upper = 1.00e10",
            "kc   = { recommended = \"hertz\", lower = 1.00e2, upper = 1.00e11",
        ),
    ] {
        copy.replace(TOML, number, formula);
    }
    let case = case::load(copy.folder.path(), &Overrides::default()).unwrap();
    let recommended = |at: usize| case.unknowns[at].start;
    assert!((recommended(0) / 3.1416e8 - 1.0).abs() < 1e-4);
    // per degree, and a quarter of what Table 3 recommends
    assert!((recommended(3) / 34.27 - 1.0).abs() < 1e-3);
    assert!((1.0e10..1.1e10).contains(&recommended(8)));
}

/// Checks that reduced tables of the head become stale when one of their inputs changes (material, arc,
/// position of a gauge), and that the error offers to reduce the head again.
#[test]
fn tables_of_the_head_know_what_they_were_computed_from() {
    type Change = fn(&Copy);
    let changes: [Change; 4] = [
        |_| {},
        |c| {
            let density = "density_kg_m3 = 7850.0                                 #";
            c.replace(TOML, density, &format!("young_gpa = 205.0\n{density}"));
        },
        |c| c.replace(TOML, "center_x_m = -0.15 ", "center_x_m = -0.1501 "),
        |c| c.replace(MODES, "\"x_m\": -1.060622", "\"x_m\": -1.060621"),
    ];
    for (number, change) in changes.iter().enumerate() {
        let copy = Copy::new();
        let (_, source) = load_head(copy.folder.path()).unwrap();
        assert!(!source.stale);
        let own = format!("{{\"source_blake3\": \"{}\", ", source.source_blake3);
        copy.replace(MODES, "{", &own);
        change(&copy);
        let loaded = case::load(copy.folder.path(), &Overrides::default());
        let (_, source) = load_head(copy.folder.path()).unwrap();
        assert_eq!(source.stale, number > 0, "change {number}");
        assert_eq!(loaded.is_err(), number > 0, "change {number}");
    }
}
