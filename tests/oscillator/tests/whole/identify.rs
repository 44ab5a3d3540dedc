//! Tests of `identify`: all unknowns are identified, with intervals that contain the true values, where the
//! model is complete, and a diagnosis is recommended first where it is not.
use crate::foreign_terms;
use crate::rig::{Rig, number};
use oscillator::case_folder::HIDDEN;
use oscillator::simulate::Values;
use serde_json::{Value, json};

fn identified(rig: &Rig, run: &str) -> Value {
    let object = rig.json(&["identify", "CASE", "--run", run]);
    foreign_terms::check_folder(run.as_ref());
    object
}

/// Removes the wall time from a program's result, so that results can be compared.
fn said(mut object: Value) -> Value {
    object["wall_s"] = Value::Null;
    object
}

#[test]
fn a_record_that_lacks_nothing_shows_every_unknown() {
    let rig = Rig::healthy();
    let run = rig.path("seen");
    let object = identified(&rig, &run);
    assert_eq!(object["diagnose_first"], false, "{object}");
    let truth = [
        ("mass", HIDDEN.mass_kg, "kg"),
        ("left", HIDDEN.left_n_per_mm, "N/mm"),
        ("damping", HIDDEN.damping_n_s_per_m, "N.s/m"),
        ("lead", HIDDEN.lead_deg, "deg"),
    ];
    let unknowns = object["unknowns"].as_object().unwrap();
    // what is fixed, tied or off is not fitted
    assert_eq!(unknowns.len(), truth.len(), "{unknowns:?}");
    for (name, hidden, unit) in truth {
        let own = &unknowns[name];
        assert_eq!((&own["seen"], &own["unit"]), (&json!("both"), &json!(unit)));
        let [low, high] = [0, 1].map(|end| number(&own["ci95"][end]));
        let half = 0.5 * (high - low);
        assert!(low < number(&own["value"]) && number(&own["value"]) < high);
        // two half widths: four of four at 95 % would fail one time in five
        assert!(
            (f64::midpoint(low, high) - hidden).abs() < 2.0 * half,
            "{name}: {own}"
        );
        assert!(half < 0.1 * hidden, "{name}: {own}");
    }
    let directions = object["directions"].as_array().unwrap();
    assert_eq!(directions.len(), truth.len());
    let first = &directions[0];
    assert!(
        number(&first["sd_decades"]) > 0.0 && first["words"].is_string(),
        "{first}"
    );
    assert!(number(&first["parts"][0]["part"]) > 0.0 && first["parts"][0]["name"].is_string());
    for condition in ["steady_5hz", "steady_7hz", "release"] {
        let own = &object["prediction"][condition];
        let axis = if condition == "release" {
            "time"
        } else {
            "phase"
        };
        let length = own[axis].as_array().unwrap().len();
        assert_eq!(own["unit"], "mm", "{own}");
        for (channel, unit) in [("displacement", Value::Null), ("force", json!("N"))] {
            let band = &own[channel];
            assert_eq!(band["unit"], unit);
            let [low, high] = ["low", "high"].map(|end| band[end].as_array().unwrap());
            assert_eq!((low.len(), high.len()), (length, length));
            let mut ends = low.iter().zip(high);
            assert!(
                ends.all(|(low, high)| number(low) <= number(high)),
                "{channel}"
            );
        }
    }
    // again, and told again, from the journal
    assert_eq!(said(identified(&rig, &run)), said(object.clone()));
    assert_eq!(said(rig.json(&["report", &run])), said(object));
    let text = rig.run(&["report", &run]);
    assert!(text.contains("sees 4 of 4 unknowns"), "{text}");
}

#[test]
fn what_lacks_something_is_sent_to_the_diagnosis_first() {
    let rig = Rig::new();
    let run = rig.path("seen");
    let object = identified(&rig, &run);
    assert_eq!(object["diagnose_first"], true, "{object}");
    assert!(number(&object["times_noise"]) > 1.5, "{object}");
    let unknowns = object["unknowns"].as_object().unwrap();
    for (name, own) in unknowns {
        let bounds = [&own["ci95"], &own["seen"], &own["profile"][0]];
        assert!(bounds.iter().all(|bound| bound.is_null()), "{name}: {own}");
    }
    let text = rig.run(&["report", &run]);
    assert!(text.contains("horsehead diagnose"), "{text}");
    assert!(text.contains("no unknown has an interval"), "{text}");
    assert!(!text.contains("95 %"), "{text}");
}

/// Checks that prior knowledge in the case narrows the intervals in every accepted form, and that wrong forms
/// are refused by field.
#[test]
fn what_is_known_beforehand_is_read_in_every_form() {
    let rig = Rig::healthy();
    let file = rig.file("case/case.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let with = |after: &str, prior: &str| {
        assert_eq!(text.matches(after).count(), 1);
        let text = text.replace(after, &format!("{after}\nprior = {prior}"));
        std::fs::write(&file, text).unwrap();
    };
    let mass = "title = \"mass of the carriage\"";
    let lead = "title = \"lead of the shaker's force\"";
    let forms = [
        (mass, "{ value = 2.13, factor = 1.001 }"),
        (mass, "{ value = 2.13, deviation = 0.0002 }"),
        (mass, "[2.128, 2.132]"),
        (lead, "[1.69, 1.71]"),
    ];
    for (number_of, (after, prior)) in forms.into_iter().enumerate() {
        with(after, prior);
        let name = if after == mass { "mass" } else { "lead" };
        let object = rig.json(&[
            "identify",
            "CASE",
            "--run",
            &rig.path(&number_of.to_string()),
        ]);
        let [low, high] = [0, 1].map(|end| number(&object["unknowns"][name]["ci95"][end]));
        assert!(high - low < 0.03 && high > low, "{prior}: {low} {high}");
    }
    for (after, prior, words) in [
        (mass, "[3.0, 2.0]", "ascending"),
        (mass, "{ value = 2.0, factor = 0.5 }", "a factor above 1"),
        (
            mass,
            "{ value = 2.0, factr = 2.0 }",
            "an interval [low, high]",
        ),
        (lead, "{ value = 2.0, factor = 2.0 }", "logarithmic scale"),
    ] {
        with(after, prior);
        let error = rig.refused(&["case", "check", "CASE"]);
        assert!(error.contains(words) && error.contains("prior"), "{error}");
    }
}

/// Checks that 95 % intervals contain the truth in 90 to 99 % of cases, over records with different values
/// and noise, with the effect in the records included in the model.
#[test]
#[ignore = "a minute or two of simulations: tests/README.md says how"]
fn intervals_hold_the_hidden_values_as_often_as_they_say() {
    const RECORDS: u32 = 40;
    let mut held: Vec<(&str, u32)> = Vec::new();
    let mut all = 0;
    for record in 0..RECORDS {
        // spread evenly, and each by itself
        let share = |step: u32| f64::from(record * step % RECORDS) / f64::from(RECORDS) - 0.5;
        let values = Values {
            mass_kg: HIDDEN.mass_kg * (1.0 + 0.2 * share(3)),
            left_n_per_mm: HIDDEN.left_n_per_mm * (1.0 + 0.2 * share(7)),
            right_n_per_mm: HIDDEN.left_n_per_mm * (1.0 + 0.2 * share(7)),
            damping_n_s_per_m: HIDDEN.damping_n_s_per_m * (1.0 + 0.5 * share(9)),
            lead_deg: 6.0 * share(11),
            ..HIDDEN
        };
        let friction = 2.4 * (1.0 + share(13));
        let rig = Rig::with_friction(&values, friction, 1 + u64::from(record));
        let object = rig.json(&["identify", "CASE", "--run", &rig.path("seen")]);
        for (name, hidden) in [
            ("mass", values.mass_kg),
            ("left", values.left_n_per_mm),
            ("damping", values.damping_n_s_per_m),
            ("lead", values.lead_deg),
            ("dry_friction.force", friction),
        ] {
            let [low, high] = [0, 1].map(|end| number(&object["unknowns"][name]["ci95"][end]));
            let inside = u32::from((low..=high).contains(&hidden));
            match held.iter_mut().find(|(one, _)| *one == name) {
                Some((_, count)) => *count += inside,
                None => held.push((name, inside)),
            }
            all += 1;
        }
    }
    let total: u32 = held.iter().map(|(_, count)| count).sum();
    eprintln!("{total} of {all} intervals hold the truth, of {RECORDS} each: {held:?}");
    let share = f64::from(total) / f64::from(all);
    assert!((0.9..=0.99).contains(&share), "{share}");
}
