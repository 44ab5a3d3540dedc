//! Tests of scoring and score table: outcomes of a few verdicts, and their counts.
use crate::files::Channels;
use crate::law::Nuisances;
use crate::plan::{Answer, AnswerEffect, Stratum};
use crate::scoring::{Outcome, Trial};
use crate::table::table;
use std::collections::BTreeMap;

fn answer(stratum: Stratum, ids: &[&str]) -> Answer {
    let effects = ids.iter().map(|id| AnswerEffect {
        id: (*id).to_owned(),
        listed: true,
        parameter: "force".to_owned(),
        value: 900.0,
        unit: "N".to_owned(),
        times_scale: 1.0,
        shape: BTreeMap::new(),
    });
    Answer {
        seed: 1,
        stratum,
        case: "case".to_owned(),
        noise: 1.0,
        cycles: 5,
        genes: BTreeMap::new(),
        effects: effects.collect(),
        nuisances: Nuisances::default(),
        channels: Channels::default(),
    }
}

fn trial(stratum: Stratum, ids: &[&str], verdict: &str) -> Trial {
    Trial {
        name: "set".to_owned(),
        answer: answer(stratum, ids),
        verdict: serde_json::from_str(verdict).unwrap(),
    }
}

const PACKING: &str = r#"{"verdict": "ambiguous",
    "effects": [
        {"id": "stuffing_box_friction", "added": true,
         "parameters": {"force": {"value": 990.0, "unit": "N", "ci95": [880.0, 1100.0]}}},
        {"id": "pivot_friction", "added": false, "parameters": {}}],
    "rounds": [{"added": "stuffing_box_friction", "set": ["stuffing_box_friction", "pivot_friction"]},
               {"added": null, "set": []}],
    "detection_limits": [{"id": "stuffing_box_friction", "parameter": "force", "unit": "N", "size": 150.0},
                         {"id": "pivot_friction", "parameter": "moment", "unit": "N.m", "size": null}],
    "gap": {"other_condition": {"before": 0.1, "after": 0.01, "closed": 0.9, "ci95": null}}}"#;

#[test]
fn a_right_name_a_set_that_holds_the_truth_and_a_false_name() {
    let right = trial(Stratum::Single, &["stuffing_box_friction"], PACKING);
    assert!(right.first_is_right() && right.first_set_contains_truth() && right.false_names() == 0);
    // its own limit counts nothing; that of an empty set of the same noise does
    let alone = [right.clone()];
    assert_eq!(right.size_over_detection_limit(&alone), None);
    let empty = trial(Stratum::Zero, &[], PACKING);
    let mut louder = empty.clone();
    louder.answer.noise = 2.0;
    assert_eq!(right.size_over_detection_limit(&[louder]), None);
    assert!((right.size_over_detection_limit(&[empty]).unwrap() - 6.0).abs() < 1e-12);
    let sizes = right.size_errors();
    assert!((sizes[0].0 - 0.1).abs() < 1e-12 && sizes[0].1 && sizes.len() == 1);
    assert_eq!(right.outcome(), Outcome::NamedFirst);
    let alike = trial(Stratum::Single, &["pivot_friction"], PACKING);
    assert!(
        !alike.first_is_right() && alike.first_set_contains_truth() && alike.false_names() == 0
    );
    let wrong = trial(Stratum::Single, &["gauge_drift"], PACKING);
    assert!(!wrong.first_set_contains_truth() && wrong.false_names() == 1);
    assert_eq!(wrong.label(), "FALSE NAME");
    assert_eq!(
        (alike.outcome(), wrong.outcome()),
        (Outcome::InAmbiguitySet, Outcome::WrongName)
    );
}

#[test]
fn claims_are_counted_by_stratum() {
    let nothing = r#"{"verdict": "nothing_detected"}"#;
    let unlisted = r#"{"verdict": "unlisted", "effects": []}"#;
    let trials = [
        trial(Stratum::Zero, &[], nothing),
        trial(Stratum::Zero, &[], PACKING),
        trial(Stratum::Below, &["gauge_drift"], nothing),
        trial(Stratum::Outside, &["beam_gust"], unlisted),
        trial(Stratum::Outside, &["beam_gust"], nothing),
        trial(
            Stratum::Double,
            &["stuffing_box_friction", "gauge_drift"],
            PACKING,
        ),
        trial(Stratum::Single, &["stuffing_box_friction"], PACKING),
    ];
    let table = table(&trials, 2).unwrap();
    for line in [
        "| zero: any claim | <= 5 % | 1/2 = 50 % [1-99] |",
        "| below the limit: any claim | <= 5 % | 0/1 = 0 % [0-98] |",
        "| outside, detected: unlisted | >= 90 % | 1/1 = 100 % [2-100] |",
        "| double: exactly both | >= 60 % | 0/1 = 0 % [0-98] |",
        "| double: at least one | >= 85 % | 1/1 = 100 % [2-100] |",
        "| single: first name right |  | 1/1 = 100 % [2-100] |",
        "| single: not named |  | 0/1 = 0 % [0-98] |",
        "| single, at least 3 x the limit of an empty set: first name right | >= 85 % | 1/1 = 100 % [2-100] |",
        "| false names of all names | <= 10 % | 1/3 = 33 % [1-91] |",
        "7 sets judged, 2 without a verdict.",
    ] {
        assert!(table.contains(line), "{line}\n{table}");
    }
}

#[test]
fn what_is_listed_as_absorbed_and_intervals_of_instruments_count() {
    let said = r#"{"verdict": "unresolved", "effects": [],
        "absorbed": [{"id": "post_compliance", "share": 0.99, "measurement": "a gauge on the post"}],
        "nuisances": [{"id": "crank_angle_offset", "parameter": "angle", "ci95": [0.01, 0.2]},
                      {"id": "gauge_gain", "parameter": "gain_2", "ci95": [-0.001, 0.001]},
                      {"id": "position_gain", "parameter": "gain", "ci95": [0.1, 0.2]}]}"#;
    let mut post = trial(Stratum::Single, &["post_compliance"], said);
    post.answer.nuisances.index_deg = 0.1;
    post.answer.nuisances.gauge_factor[1] = 0.004;
    assert!(post.lists_absorbed() && post.names_no_effect());
    assert_eq!(post.label(), "listed as absorbed");
    assert_eq!(post.nuisances_held(), [1, 3]);
    let table = table(&[post], 0).unwrap();
    for line in [
        "| single: not named, listed as absorbed |  | 1/1 = 100 %",
        "| single: first name right |  | 0/1 = 0 %",
        "| single, below that or without such a limit |  | 1 |",
    ] {
        assert!(table.contains(line), "{line}\n{table}");
    }
    assert!(table.contains("| 95 % intervals of instruments hold | 90 to 98 % | 1/3 = 33 %"));
}
