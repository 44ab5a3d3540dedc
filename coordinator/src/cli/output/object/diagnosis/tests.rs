//! Tests of the JSON object printed by `horsehead diagnose CASE --output json`: field names and values for
//! every verdict.
use super::answer::object;
use discrepancy::{
    diagnose::{
        Diagnosis, Estimate, ForceEstimate, IndistinguishablePair, Left, Limit, ParameterEstimate,
        Remainder, Round,
    },
    laboratory::Stage,
    localisation::{
        joint, order,
        parameter_drift::{ParameterDrift, ParameterShift, RecordPart},
        summary::Localisation,
        window_test,
    },
    model::{Fit, FittedModel},
    validation::{
        compare::{DataRole, GapRow},
        gap_closure::Closed,
        predictive::Prediction,
    },
    verdict::Verdict,
};
use protocol::case::Case;
use record::{Record, Recorded, Stated, noise::NoiseSource};
use report::{Origin, diagnosis::DiagnosisInput};
use search::{
    least_squares::{LeastSquares, LeastSquaresSettings},
    space::Space,
};
use serde_json::Value;
use std::{path::Path, time::Duration};
use study::{DiagnosisResult, RecordedDiagnosis, StageCost};

fn case() -> Case {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    case::load(&folder, &case::Overrides::default()).unwrap()
}

fn row(part: DataRole, closed: f64) -> GapRow {
    GapRow {
        condition: usize::from(part == DataRole::Condition),
        part,
        held_out: false,
        closed: Closed {
            before: 0.04,
            after: 0.04 * (1.0 - closed),
            closed,
            interval: (part == DataRole::Fitted).then_some([closed - 0.1, closed + 0.1]),
        },
        before: Vec::new(),
        after: Vec::new(),
    }
}

fn estimate(id: &str) -> Estimate {
    Estimate {
        id: id.to_owned(),
        title: "Drift of the gauges".to_owned(),
        unknowns: Vec::new(),
        parameters: vec![ParameterEstimate {
            name: "size".to_owned(),
            unit: "MPa".to_owned(),
            value: 0.5,
            interval: [0.4, 0.6],
        }],
        p_value: 1e-9,
        ln_evidence: 120.5,
    }
}

/// Returns a diagnosis with nothing but a verdict and its reason.
fn bare(verdict: Verdict) -> Diagnosis {
    Diagnosis {
        verdict,
        noise: NoiseSource::Stated,
        ..Diagnosis::unresolved("because")
    }
}

/// Returns a diagnosis with every field filled that does not require a fit.
fn full(verdict: Verdict) -> Diagnosis {
    let set = vec!["gauge_drift".to_owned(), "gauge_gain".to_owned()];
    let parts = [
        (DataRole::Fitted, 0.9),
        (DataRole::Cycles, 0.8),
        (DataRole::Condition, 0.7),
    ];
    let rows = parts.map(|(part, closed)| row(part, closed)).to_vec();
    Diagnosis {
        reason: None,
        effects: set.iter().map(|id| estimate(id)).collect(),
        rounds: vec![Round {
            trace: None,
            ranked: 1,
            together: false,
            candidates: Vec::new(),
            generics: Vec::new(),
            refits: Vec::new(),
            null_evidence: -900.0,
            dispersion: 1.0,
            misfit: 1.0,
            p_value: 1e-9,
            set,
            added: Some("gauge_drift".to_owned()),
            reason: None,
        }],
        localisation: Some(Localisation {
            along: window_test::AlongMap {
                bins: Vec::new(),
                strength: Vec::new(),
                windows: vec![window_test::AbscissaWindow {
                    channel: 1,
                    from: 345.0,
                    to: 378.0,
                    strength: -9.0,
                    p_value: 0.0025,
                }],
            },
            order: order::OrderMap {
                ratio: Vec::new(),
                peaks: Vec::new(),
            },
            joints: vec![joint::JointEvidence {
                joint: "saddle".to_owned(),
                log_bayes: f64::NEG_INFINITY,
                force: Vec::new(),
                unit: "N.m".to_owned(),
            }],
            equivalent: 1,
        }),
        limits: vec![Limit {
            id: "beam_inertia".to_owned(),
            parameter: "share".to_owned(),
            unit: "1".to_owned(),
            size: 3.0,
            largest: 0.5,
        }],
        look_alikes: vec![IndistinguishablePair {
            effects: ["gauge_drift".to_owned(), "gauge_gain".to_owned()],
            cycles: 2.5,
            cycles_with_others: None,
        }],
        rows: rows.clone(),
        prediction: [(0, DataRole::Cycles, 71.5), (1, DataRole::Condition, -0.5)]
            .map(|(condition, part, nats)| Prediction {
                condition,
                part,
                nats,
            })
            .to_vec(),
        rival: Some(("rope_toe".to_owned(), rows)),
        noise: NoiseSource::Measured,
        ..bare(verdict)
    }
}

fn printed(diagnosis: Diagnosis) -> Value {
    let case = case();
    let records = vec![Record {
        condition: case.objective.condition,
        channels: [0, 2]
            .map(|at| Recorded::new(at, &case.channels[at]))
            .into(),
        cycles: Vec::new(),
        held_out: false,
        stated: Stated::default(),
    }];
    let diagnosed = DiagnosisResult {
        diagnosis,
        accounts: vec![(
            Stage::Test,
            StageCost {
                experiments: 40,
                with_derivatives: 10,
                known: 5,
                failed: 2,
                batches: 3,
            },
        )],
        library: Vec::new(),
        notes: Vec::new(),
    };
    let diagnosed = RecordedDiagnosis {
        result: diagnosed,
        records,
        slot_times: [(Stage::Test.name().to_owned(), Duration::from_millis(1500))].into(),
        damage: Vec::new(),
    };
    let subject = DiagnosisInput {
        case: &case,
        diagnosed: &diagnosed,
        origin: Origin::default(),
        assessments: Vec::new(),
        wall_s: 2.0,
    };
    let text = serde_json::to_string(&object(&subject)).unwrap();
    serde_json::from_str(&text).unwrap()
}

#[test]
fn every_verdict_has_its_word_and_every_field_of_the_contract() {
    for (verdict, word) in [
        (Verdict::NothingDetected, "nothing_detected"),
        (Verdict::Named, "named"),
        (Verdict::Ambiguous, "ambiguous"),
        (Verdict::Unlisted, "unlisted"),
        (Verdict::Unresolved, "unresolved"),
    ] {
        for diagnosis in [bare(verdict), full(verdict)] {
            let said = printed(diagnosis);
            assert_eq!(said["verdict"], word);
            let fields = said.as_object().unwrap();
            for field in [
                "effects",
                "traces",
                "discrepancy",
                "rounds",
                "where",
                "detection_limits",
                "nuisances",
                "absorbed",
                "ran_out",
                "gap",
                "prediction",
                "rival",
                "reason",
                "generic",
                "generic_force",
                "stages",
            ] {
                assert!(fields.contains_key(field), "{word} has no {field}");
            }
        }
    }
}

/// Checks the JSON form of a generic force; its fit is left empty because fitting would need a record.
#[test]
fn a_force_without_a_cause_is_printed_with_its_size() {
    let case = case();
    let space = Space::new(&case.unknowns).unwrap();
    let model = FittedModel::plain(space);
    let search = LeastSquares::new(model.variables(&[]), LeastSquaresSettings::default());
    let found = ForceEstimate {
        id: "probe.saddle.cos3".to_owned(),
        joint: "saddle".to_owned(),
        form: "harmonic 3".to_owned(),
        amplitude: 900.0,
        unit: "N.m".to_owned(),
        interval: [800.0, 1000.0],
        phase_deg: Some(-40.0),
        ln_evidence: 75.0,
        fit: Fit::new(model, (search, Vec::new()), None).summary(),
        rows: vec![row(DataRole::Fitted, 0.9), row(DataRole::Condition, 0.7)],
    };
    let said = printed(Diagnosis {
        generic: Some(found.id.clone()),
        force: Some(found),
        ..full(Verdict::Unlisted)
    });
    assert_eq!(said["generic"], "probe.saddle.cos3");
    let force = &said["generic_force"];
    assert_eq!(force["joint"], "saddle");
    assert_eq!(force["form"], "harmonic 3");
    let amplitude = serde_json::json!({"value": 900.0, "unit": "N.m", "ci95": [800.0, 1000.0]});
    assert_eq!(force["amplitude"], amplitude);
    assert_eq!(force["phase_deg"], -40.0);
    assert_eq!(force["gap"]["other_condition"]["closed"], 0.7);
    assert!(printed(full(Verdict::Named))["generic_force"].is_null());
}

/// Checks the JSON form of unknowns whose value would have to vary: sectors of the turn are given by angles,
/// other conditions by name, both with the refitted value.
#[test]
fn wandering_genes_have_their_values() {
    let case = case();
    let model = FittedModel::plain(Space::new(&case.unknowns).unwrap());
    let search = LeastSquares::new(model.variables(&[]), LeastSquaresSettings::default());
    let sector = RecordPart::Sector {
        from: 90.0,
        to: 180.0,
    };
    let shift = |part, by| ParameterShift {
        part,
        by,
        p_value: 0.01,
    };
    let said = printed(Diagnosis {
        before: Some(Fit::new(model, (search, Vec::new()), None).summary()),
        drifts: vec![ParameterDrift {
            unknown: 1,
            shifts: vec![shift(sector, 1.0), shift(RecordPart::Condition(1), -1.0)],
            explained: 0.25,
        }],
        ..full(Verdict::Named)
    });
    let first = &said["wander"]["before"][0];
    assert_eq!(first["gene"], case.unknowns[1].name);
    assert_eq!(first["explained"], 0.25);
    let [turn, speed] = [&first["parts"][0], &first["parts"][1]];
    assert_eq!(turn["sector_deg"], serde_json::json!([90.0, 180.0]));
    assert!(turn["condition"].is_null() && speed["sector_deg"].is_null());
    assert_eq!(speed["condition"], case.conditions[1].name);
    for (part, factor) in [(turn, 10.0), (speed, 0.1)] {
        let ratio = part["value"].as_f64().unwrap() / case.unknowns[1].start;
        assert!((ratio / factor - 1.0).abs() < 1e-12, "{ratio}");
    }
    assert_eq!(said["wander"]["after"], serde_json::json!([]));
}

/// Checks the fields that say how much an answer explains: a stage that ran out or a record with more than noise
/// make it one in part, the localisation alone does not.
#[test]
fn what_is_left_stands_beside_the_verdict() {
    let whole = printed(full(Verdict::Named));
    assert_eq!(whole["in_part"], false);
    assert_eq!(whole["left"], serde_json::json!([]));
    let part = printed(Diagnosis {
        remainder: Remainder {
            discrepancy: None,
            explained: Some(0.71),
            left: vec![Left {
                condition: 1,
                part: DataRole::Condition,
                share: 0.29,
                channel: "gauge 3".to_owned(),
                between: [200.0, 260.0],
                unit: "deg".to_owned(),
            }],
            is_converged: true,
            at_bounds: vec!["kb1".to_owned()],
            beyond: vec!["gauge_gain.gain_1 at 6.0 tolerances".to_owned()],
        },
        ..full(Verdict::Named)
    });
    assert_eq!(part["in_part"], true);
    assert_eq!(part["explained"], 0.71);
    assert_eq!(part["converged"], true);
    assert_eq!(part["at_bounds"], serde_json::json!(["kb1"]));
    let beyond = serde_json::json!(["gauge_gain.gain_1 at 6.0 tolerances"]);
    assert_eq!(part["beyond"], beyond);
    let left = serde_json::json!({"record": "4rpm", "held_out": "condition", "share": 0.29,
        "channel": "gauge 3", "between": [200.0, 260.0], "unit": "deg"});
    assert_eq!(part["left"], serde_json::json!([left]));
    for (stage, in_part) in [
        (Stage::Where, false),
        (Stage::Basin, false),
        (Stage::Refit, true),
    ] {
        let ran_out = vec![stage];
        let said = printed(Diagnosis {
            ran_out,
            ..full(Verdict::Named)
        });
        assert_eq!(said["in_part"], in_part, "{stage:?}");
    }
}

#[test]
fn a_diagnosis_that_stopped_has_empty_lists_and_nulls() {
    let said = printed(bare(Verdict::Unresolved));
    assert_eq!(said["reason"], "because");
    // suspects are no effects of an answer
    let suspected = printed(full(Verdict::Unresolved));
    assert_eq!(suspected["effects"], Value::Array(Vec::new()));
    assert_eq!(suspected["rounds"].as_array().map(Vec::len), Some(1));
    for list in [
        "effects",
        "rounds",
        "detection_limits",
        "inseparable",
        "data_worth",
    ] {
        assert_eq!(said[list], Value::Array(Vec::new()), "{list}");
    }
    assert!(said["where"].is_null() && said["rival"].is_null());
    for part in ["calibration", "held_out", "other_condition"] {
        assert!(said["gap"].as_object().unwrap().contains_key(part));
        assert!(said["gap"][part].is_null(), "{part}");
    }
}

#[test]
fn effects_gaps_and_limits_are_as_documented() {
    let said = printed(full(Verdict::Ambiguous));
    let first = &said["effects"][0];
    assert_eq!(first["id"], "gauge_drift");
    assert_eq!(first["added"], true);
    assert_eq!(said["effects"][1]["added"], false);
    assert_eq!(first["parameters"]["size"]["value"], 0.5);
    assert_eq!(first["parameters"]["size"]["unit"], "MPa");
    assert_eq!(
        first["parameters"]["size"]["ci95"],
        serde_json::json!([0.4, 0.6])
    );
    assert_eq!(first["p_value"], 1e-9);
    assert_eq!(first["ln_evidence"], 120.5);
    let gap = &said["gap"];
    for (part, closed) in [
        ("calibration", 0.9),
        ("held_out", 0.8),
        ("other_condition", 0.7),
    ] {
        assert_eq!(gap[part]["closed"], closed, "{part}");
        assert_eq!(gap[part]["before"], 0.04);
    }
    assert!(gap["calibration"]["ci95"].is_array() && gap["held_out"]["ci95"].is_null());
    assert_eq!(said["rival"]["id"], "rope_toe");
    assert_eq!(said["rival"]["gap"]["held_out"]["closed"], 0.8);
    let [cycles, condition] = [0, 1].map(|k| &said["prediction"][k]);
    assert_eq!(cycles["held_out"], "cycles");
    assert_eq!(
        (&condition["record"], &condition["held_out"]),
        (&"4rpm".into(), &"condition".into())
    );
    assert_eq!(condition["nats"], -0.5);
    let window = &said["where"]["windows"][0];
    assert_eq!(window["channel"], "gauge 3");
    assert_eq!(window["from_deg"], 345.0);
    // infinities are null: JSON has none
    assert!(said["detection_limits"][0]["size"].is_null());
    assert!(said["where"]["joints"][0]["ln_bayes"].is_null());
    let pair = serde_json::json!(["gauge_drift", "gauge_gain"]);
    assert_eq!(said["inseparable"][0], pair);
    assert_eq!(said["data_worth"][0]["effects"], pair);
    assert_eq!(said["data_worth"][0]["cycles"], 2.5);
    assert!(said["data_worth"][0]["cycles_with_other_conditions"].is_null());
    assert_eq!(said["stages"][0]["simulations"], 40);
    assert_eq!(said["stages"][0]["batches"], 3);
    assert_eq!(said["stages"][0]["busy_s"], 1.5);
}
