//! Tests of the contract of `--output json` for a pumping unit: the field names of every object.
use crate::cli::output::{
    model::simulation_digest,
    object::{
        calibration::CalibrateOutput,
        score::{condition, unknowns},
        simulation::{VerdictOutput, simulation},
    },
};
use protocol::pumping_unit::failure;
use protocol::{
    case::Case,
    job::{ChannelScore, Counters, Evaluation, Reached, Verdict},
    pumping_unit::{Energy, HeadLoads, Simulation},
};
use serde_json::Value;
use std::{collections::BTreeMap, path::Path};
use study::ComparedCurves;

fn case() -> Case {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    case::load(&folder, &case::Overrides::default()).unwrap()
}

fn curves(verdict: Verdict) -> ComparedCurves {
    let score = |channel| ChannelScore {
        channel,
        mse: 0.25,
        mse_fixed_offset: 0.5,
        offset: 0.5,
        rmse_over_half_range: 0.125,
        relative_error: 0.0625,
        peak_to_peak_error: -0.03125,
    };
    let complete = verdict == Verdict::Complete;
    ComparedCurves {
        name: "recommended".to_owned(),
        genes: case().start(),
        evaluation: Some(Evaluation {
            verdict,
            fitness: 0.5,
            channels: if complete {
                vec![score(0), score(2)]
            } else {
                Vec::new()
            },
            residual: Vec::new(),
            columns: Vec::new(),
            counters: Counters::default(),
        }),
        drawn: drawing(verdict).into_curves(Vec::new()).unwrap(),
    }
}

fn drawing(verdict: Verdict) -> Simulation {
    Simulation {
        verdict,
        counters: Counters {
            steps: 300,
            ..Counters::default()
        },
        wall_s: 0.25,
        turn_deg: vec![0.0, 0.5],
        gauge_mpa: [vec![1.0, 2.0], vec![3.0; 2], vec![4.0; 2], vec![5.0; 2]],
        back_rope_tension_n: vec![1e5; 2],
        front_rope_tension_n: vec![9e4; 2],
        tension_difference_n: [Vec::new(), Vec::new()],
        beam_deg: vec![6.0; 2],
        suspension_m: vec![7.0; 2],
        suspension_velocity_m_s: vec![8.0; 2],
        suspension_acceleration_m_s2: vec![9.0; 2],
        crank_torque_n_m: vec![10.0; 2],
        modal: Vec::new(),
        head_loads: HeadLoads::default(),
        energy: Energy {
            input_j: 11.0,
            ..Energy::default()
        },
        motion: Vec::new(),
    }
}

fn fields(value: &Value) -> Vec<&str> {
    let mut fields: Vec<&str> = value
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    fields.sort_unstable();
    fields
}

#[test]
fn a_simulation_has_the_fields_that_programs_rely_on() {
    let (case, curves) = (case(), curves(Verdict::Complete));
    let digest = simulation_digest(&drawing(Verdict::Complete));
    let value = simulation((&case, 0), &curves, &[], digest).unwrap();
    let value = serde_json::to_value(value).unwrap();
    assert_eq!(
        fields(&value),
        [
            "beam_deg",
            "case",
            "channels",
            "condition",
            "counters",
            "crank_deg",
            "crank_torque_nm",
            "digest",
            "energy",
            "front_rope_tension_n",
            "gauge_mpa",
            "genes",
            "objective",
            "rope_tension_n",
            "suspension_m",
            "verdict",
            "wall_s"
        ]
    );
    assert_eq!(value["verdict"], "complete");
    assert_eq!(value["condition"], "5rpm");
    assert_eq!(fields(&value["gauge_mpa"]), ["1", "2", "3", "4"]);
    assert_eq!(value["gauge_mpa"]["1"][1], 2.0);
    assert_eq!(
        fields(&value["counters"]),
        [
            "factorizations",
            "jacobians",
            "newton_iterations",
            "rejected_steps",
            "steps"
        ]
    );
    assert_eq!(
        fields(&value["energy"]),
        [
            "dissipated_j",
            "input_j",
            "output_j",
            "relative_error",
            "stored_j"
        ]
    );
}

#[test]
fn a_failed_simulation_says_what_happened_and_how_far_it_got() {
    let kind = failure::LOAD_NOT_LIFTED;
    let verdict = Verdict::Failed {
        kind,
        reached: Reached::LoadFraction(0.75),
    };
    let (case, failed) = (case(), curves(verdict));
    let value =
        serde_json::to_value(simulation((&case, 0), &failed, &[], String::new()).unwrap()).unwrap();
    assert!(value["energy"].is_null());
    assert_eq!(value["verdict"], "load_not_lifted");
    assert_eq!(value["load_fraction"], 0.75);
    assert!(value.get("time_fraction").is_none());
    assert_eq!(value["objective"], Value::Null);
    let verdict = Verdict::Failed {
        kind,
        reached: Reached::TimeFraction(0.5),
    };
    let value = serde_json::to_value(VerdictOutput::from(verdict)).unwrap();
    assert_eq!(value["time_fraction"], 0.5);
}

#[test]
fn a_calibration_has_the_fields_that_programs_rely_on() {
    let case = case();
    let (before, after) = (curves(Verdict::Complete), curves(Verdict::Complete));
    let scores = condition(&case, &before, &after);
    let object = CalibrateOutput {
        rivals: Vec::new(),
        run: "runs/x".to_owned(),
        case: &case.name,
        preset: "quick",
        seed: 1,
        evaluations: 900,
        failed_simulations: 44,
        wall_s: 1.5,
        unknowns: unknowns(&case, &case.start()),
        objective: scores.objective,
        channels: scores.channels,
        other_conditions: BTreeMap::from([("4rpm".to_owned(), condition(&case, &before, &after))]),
        machine: Vec::new(),
        log_digest: "00".to_owned(),
        files: Vec::new(),
    };
    let value = serde_json::to_value(&object).unwrap();
    assert_eq!(
        fields(&value),
        [
            "case",
            "channels",
            "evaluations",
            "failed_simulations",
            "files",
            "genes",
            "log_digest",
            "machine",
            "objective",
            "other_conditions",
            "preset",
            "rivals",
            "run",
            "seed",
            "wall_s"
        ]
    );
    assert_eq!(
        fields(&value["genes"]),
        [
            "cb1", "cb23", "cb4", "cb56", "cc", "kb1", "kb23", "kb4", "kb56", "kc"
        ]
    );
    let gene = ["lower", "recommended", "unit", "upper", "value"];
    assert_eq!(fields(&value["genes"]["kb1"]), gene);
    assert_eq!(value["genes"]["kb4"]["unit"], "N.m/deg");
    assert_eq!(fields(&value["objective"]), ["optimised", "recommended"]);
    assert_eq!(fields(&value["channels"]), ["1", "3"]);
    assert_eq!(
        fields(&value["channels"]["1"]),
        ["optimised", "recommended"]
    );
    let channel = &value["channels"]["3"]["optimised"];
    for key in ["mse_mpa2", "mse"] {
        assert_eq!(channel[key], 0.25);
    }
    assert_eq!(
        (&channel["unit"], &channel["gauge"]),
        (&"MPa".into(), &3.into())
    );
    assert_eq!(channel["relative_error"], 0.0625);
    assert_eq!(channel["rmse_over_half_range"], 0.125);
    assert_eq!(
        value["other_conditions"]["4rpm"]["objective"]["optimised"],
        0.5
    );
}

#[test]
fn the_digest_of_a_simulation_sees_its_curves_but_not_its_wall_time() {
    let one = drawing(Verdict::Complete);
    let digest = simulation_digest(&one);
    assert_eq!(digest.len(), 64);
    let mut slower = one.clone();
    slower.wall_s = 9.0;
    assert_eq!(digest, simulation_digest(&slower));
    let changes: [fn(&mut Simulation); 4] = [
        |s| s.gauge_mpa[2][1] += 1e-12,
        |s| s.crank_torque_n_m[0] = -10.0,
        |s| s.counters.steps = 301,
        |s| s.energy.stored_j = 1e-9,
    ];
    for change in changes {
        let mut other = one.clone();
        change(&mut other);
        assert_ne!(digest, simulation_digest(&other));
    }
}
