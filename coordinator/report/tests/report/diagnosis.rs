//! Tests of the diagnosis report for every verdict: completeness, well-formedness and correct statements.
use crate::suspicion::{self, SampleDiagnosis};
use crate::{check_page, names, words};
use case::CaseEffect;
use discrepancy::diagnose::{DiscrepancyEstimate, Estimate, Left};
use discrepancy::validation::compare::DataRole;
use discrepancy::verdict::Verdict;
use protocol::case::Channel;
use protocol::pumping_unit::EFFECT_UNITS;
use report::document::TerminalStyle;
use report::{self, diagnosis};
use roxmltree::Document;
use std::path::Path;

const ALL: [Verdict; 5] = [
    Verdict::NothingDetected,
    Verdict::Named,
    Verdict::Ambiguous,
    Verdict::Unlisted,
    Verdict::Unresolved,
];

fn page(made: &SampleDiagnosis) -> String {
    let page = report::page(&diagnosis::report(&made.subject()));
    check_page(&page);
    page
}

fn text(subject: &diagnosis::DiagnosisInput<'_>) -> String {
    report::text(&diagnosis::report(subject), TerminalStyle::default())
}

#[test]
fn every_verdict_makes_a_page_and_a_text_without_numbers_that_are_none() {
    for verdict in ALL {
        let made = suspicion::diagnosis(verdict);
        let page = words(&page(&made));
        let text = text(&made.subject());
        for said in [&page, &text] {
            let mut tokens = said.split(|c: char| !c.is_alphanumeric());
            let none = tokens.find(|token| matches!(*token, "NaN" | "inf"));
            assert_eq!(none, None, "{verdict:?}");
        }
        let sections = [
            "Where the residual lies",
            "Candidate effects",
            "Validation: the gap before and after",
            "Reliability of the verdict",
            "How it was made",
        ];
        for section in sections {
            assert!(page.contains(section), "{verdict:?} has no {section}");
        }
        let added = matches!(verdict, Verdict::Named | Verdict::Ambiguous);
        assert_eq!(
            page.contains("Effects added to the model"),
            added,
            "{verdict:?}"
        );
        assert_eq!(page.contains("[[effects]]"), added, "{verdict:?}");
    }
}

#[test]
fn what_is_added_is_read_back_by_a_case_file() {
    #[derive(serde::Deserialize)]
    struct File {
        effects: Vec<CaseEffect>,
    }
    for verdict in [Verdict::Named, Verdict::Ambiguous] {
        let made = suspicion::diagnosis(verdict);
        let text = diagnosis::effects_toml(&made.subject()).expect("something was added");
        let file: File = toml::from_str(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let found: Vec<&String> = file.effects.iter().map(|effect| &effect.id).collect();
        let added: Vec<&String> = made
            .diagnosed
            .result
            .diagnosis
            .rounds
            .iter()
            .filter_map(|round| round.added.as_ref())
            .collect();
        assert_eq!(found, added);
        for effect in &file.effects {
            let provenance = effect.provenance.as_ref().expect("where it comes from");
            assert!(provenance.run.is_some() && provenance.dataset.is_some());
            for parameter in effect.parameters.values() {
                assert!(EFFECT_UNITS.contains(&parameter.unit.as_str()));
            }
        }
    }
}

#[test]
fn a_name_stands_with_its_size_its_rival_and_what_to_do() {
    let page = words(&page(&suspicion::diagnosis(Verdict::Named)));
    for said in [
        "The simulation lacks clearance of the <pins> & their \"bores\" (pin_clearance); it explains 99.0 % of the gap, and no more than noise is left.",
        "size = 0.800\u{a0}MPa (95\u{a0}% interval 0.700 to 0.900\u{a0}MPa)"
            .replace('\u{a0}', " ")
            .as_str(),
        "The best rejected rival is drift of the gauges (gauge_drift): on the fitted data the answer is preferred to it (practically certain)",
        "the record says that it is there (practically certain)",
        "4rpm, another condition, which took no part: 61.2 nats",
        "held-out cycles",
        "another condition, which took no part",
        "the best rejected rival, load_cell_lag",
        "appended to case.toml",
    ] {
        assert!(
            page.replace('\u{a0}', " ").contains(said),
            "{said} is not in\n{page}"
        );
    }
}

/// Checks that the first sentence of an answer in part says what is left, and where.
#[test]
fn an_answer_in_part_says_what_is_left_in_its_first_sentence() {
    let mut made = suspicion::diagnosis(Verdict::Named);
    let own = &mut made.diagnosed.result.diagnosis;
    own.reason = Some("explains 71 % of the gap; 29 % remain, most of it at gauge 3".to_owned());
    own.remainder.left = vec![Left {
        condition: 0,
        part: DataRole::Fitted,
        share: 0.29,
        channel: "gauge 3".to_owned(),
        between: [200.0, 260.0],
        unit: "deg".to_owned(),
    }];
    let page = words(&page(&made));
    let said = "In part: The simulation lacks clearance of the <pins> & their \"bores\" (pin_clearance); it explains \
                71 % of the gap; 29 % remain, most of it at gauge 3.";
    assert!(page.contains(said), "{page}");
    assert!(!page.contains("The reason:"), "{page}");
}

/// Checks that the smooth discrepancy that an answer still needs stands in the first sentence and is drawn with its
/// band, and that a trace is listed with its size.
#[test]
fn a_discrepancy_and_a_trace_are_shown() {
    let mut made = suspicion::diagnosis(Verdict::Named);
    let own = &mut made.diagnosed.result.diagnosis;
    let channels: Vec<Channel> = own.rows[0]
        .after
        .iter()
        .map(|_| made.case.channels[0].clone())
        .collect();
    let half: Vec<Vec<f64>> = own.rows[0]
        .after
        .iter()
        .map(|y| vec![0.1; y.len()])
        .collect();
    own.remainder.discrepancy = Some(DiscrepancyEstimate {
        channels,
        mean: own.rows[0].after.clone(),
        half,
        length: 0.05,
        share: 0.12,
    });
    let mut round = own.rounds[0].clone();
    round.added = None;
    round.reason = Some("gauge_drift is no more than a trace".to_owned());
    round.trace = Some("gauge_drift".to_owned());
    let size = own.effects[0].clone();
    own.rounds.push(round);
    own.sizes = vec![
        Vec::new(),
        vec![Estimate {
            id: "gauge_drift".to_owned(),
            ..size
        }],
    ];
    let page = words(&page(&made));
    for said in [
        "it explains 99.0 % of the gap, a smooth discrepancy without a cause takes 12.0 % of the gap, and no more than noise",
        "The smooth discrepancy that the model still needs beside the added effects, with its 95 % band",
        "trace, not named: gauge_drift:",
    ] {
        assert!(
            page.replace('\u{a0}', " ").contains(said),
            "{said} is not in\n{page}"
        );
    }
}

#[test]
fn every_suspect_is_told_why_it_was_kept_or_dropped() {
    let made = suspicion::diagnosis(Verdict::Ambiguous);
    let text = text(&made.subject());
    for (id, why) in [
        (
            "pin_clearance",
            "kept: the best of its ambiguity set, added",
        ),
        (
            "gauge_drift",
            "kept in the ambiguity set: 2.9 nats behind pin_clearance",
        ),
        (
            "load_cell_lag",
            "dropped: beaten by 442.9 nats by pin_clearance",
        ),
        ("rope_hysteresis", "dropped: not significant"),
        (
            "pivot_friction",
            "dropped: the records would require a physically impossible sign",
        ),
        ("gauge_gain", "dropped: recalibration absorbs it"),
        ("twin_rope_inequality", "could not be simulated here"),
        ("beam_inertia", "dropped: not significant"),
    ] {
        let line = text
            .lines()
            .find(|line| line.trim_start().starts_with(id) && line.contains(why));
        assert!(line.is_some(), "{id} without `{why}` in\n{text}");
    }
}

/// Checks that a parameter that would have to vary along the revolution is listed with its values for the
/// model without the added effects, and that none is listed for the model with them.
#[test]
fn parameters_that_would_have_to_wander_are_shown_with_their_values() {
    let made = suspicion::diagnosis(Verdict::Named);
    let before = made.diagnosed.result.diagnosis.before.as_ref().unwrap();
    let value = before.genes[0];
    let whole = page(&made).replace('\u{a0}', " ");
    let (_, section) = whole.split_once("would have to wander</h2>").unwrap();
    let (section, _) = section.split_once("</section>").unwrap();
    for said in ["90 to 180 deg", &made.case.conditions[1].name, "42"] {
        assert!(section.contains(said), "{said} is not in\n{section}");
    }
    let cells: Vec<&str> = section.split("<td").collect();
    // the digits before the power of ten
    let shown = |value: f64| format!("{:.2}", value / 10_f64.powf(value.log10().floor()));
    let bracketed = |cell: &&&str| cell.contains('(');
    assert_eq!(cells.iter().filter(bracketed).count(), 4, "{section}");
    let twice = cells
        .iter()
        .any(|cell| cell.contains(&shown(2.0 * value)) && !cell.contains('('));
    assert!(twice, "{} in\n{section}", shown(2.0 * value));
    assert!(section.contains("With the answer none would have to"));
}

#[test]
fn what_is_not_known_is_said() {
    let nothing = words(&page(&suspicion::diagnosis(Verdict::NothingDetected)));
    assert!(nothing.contains("Nothing detected"));
    assert!(
        nothing.contains("never: absorbed"),
        "an absorbed effect has no limit"
    );
    let unlisted = words(&page(&suspicion::diagnosis(Verdict::Unlisted)));
    assert!(unlisted.contains("it acts like a force on the head, as sgn v (probe.back_head.sign)"));
    let unresolved = words(&page(&suspicion::diagnosis(Verdict::Unresolved)));
    assert!(unresolved.contains("The reason: the likeliest is not enough."));
    let stopped = suspicion::stopped("there is no record of the calibrated condition");
    let said = words(&page(&stopped));
    assert!(said.contains("The reason: there is no record of the calibrated condition."));
    assert!(said.contains("The noise was stated, not seen"));
    assert!(!said.contains("Validation: the gap before and after"));
    assert!(text(&stopped.subject()).starts_with("UNRESOLVED\n"));
}

#[test]
fn two_rounds_are_two_things_that_are_missing() {
    let made = suspicion::two_rounds();
    let text = text(&made.subject());
    let said = "The simulation lacks clearance of the <pins> & their \"bores\" (pin_clearance) and one \
                of drift of the gauges (gauge_drift) or lag of the load cell (load_cell_lag); this \
                record does not tell which;";
    assert!(text.contains(said), "{text}");
    // every refit of the first round is in an answer now
    assert!(!text.contains("best rejected rival is drift"));
}

#[test]
fn a_force_without_a_cause_has_a_size_and_a_gap() {
    let made = suspicion::diagnosis(Verdict::Unlisted);
    let text = text(&made.subject()).replace('\u{a0}', " ");
    for said in [
        "amplitude 420 N (95 % interval 380 to 460 N)",
        "With that force, ",
        "the force without a cause, probe.back_head.sign",
        "before, 0.310 after (calibration cycles",
    ] {
        assert!(text.contains(said), "{said} is not in\n{text}");
    }
}

#[test]
fn a_suspect_under_assumed_noise_is_shown_and_not_named() {
    let made = suspicion::assumed();
    let text = text(&made.subject());
    let page = words(&page(&made));
    for said in [&text, &page] {
        assert!(
            said.contains("suspected, not named: pin_clearance"),
            "{said}"
        );
        assert!(said.contains("The noise was stated, not seen"), "{said}");
        for name in ["The simulation lacks", "[[effects]]", "Sizes of the answer"] {
            assert!(!said.contains(name), "{name} in\n{said}");
        }
    }
}

#[test]
fn the_folder_holds_the_figures_and_the_data_behind_them() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("diagnosis");
    let made = suspicion::diagnosis(Verdict::Named);
    let written = diagnosis::write(&folder, &made.subject()).unwrap();
    let names = names(&folder, &written);
    for name in [
        "report.html",
        "tables.txt",
        "curves.csv",
        "suspects.csv",
        "figures/where_angle.svg",
        "figures/where_order.svg",
        "figures/where_joint.svg",
        "figures/where_force.svg",
        "figures/proof_5rpm_gauge_1.svg",
        "figures/proof_4rpm_gauge_3.svg",
        "figures/proof_5rpm_crank_torque.svg",
    ] {
        assert!(names.contains(name), "{name} is not among {names:?}");
    }
    for path in &written {
        let text = std::fs::read_to_string(path).unwrap();
        if path.extension().is_some_and(|extension| extension == "svg") {
            Document::parse(&text).expect("well-formed SVG");
            assert!(!text.contains("NaN"), "{}", path.display());
        }
    }
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let curves = read("curves.csv");
    // two conditions, four channels, 360 angles
    assert_eq!(curves.lines().count(), 1 + 2 * 4 * 360);
    assert!(curves.starts_with("condition,channel,unit,at,measured,spread,before,after,rival"));
    let suspects = read("suspects.csv");
    assert_eq!(suspects.lines().count(), 1 + 8 + 1);
    let best = suspects.lines().nth(1).unwrap();
    assert!(
        best.starts_with("1,pin_clearance,") && best.contains(",true,kept"),
        "{best}"
    );
}
