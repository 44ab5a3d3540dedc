//! Synthesised diagnosis: fits of a linear model, candidate effects with tests, and the maps of the residual.
use crate::sample;
use discrepancy::baseline::discretisation_check::Preflight;
use discrepancy::diagnose::{
    Absorbed, Diagnosis, Estimate, ForceEstimate, IndistinguishablePair, Limit, NuisanceEstimate,
    ParameterEstimate, Remainder, Round,
};
use discrepancy::hypothesis::candidate::CandidateEffect;
use discrepancy::hypothesis::refit::Refitted;
use discrepancy::laboratory::Stage;
use discrepancy::linear::score::Score;
use discrepancy::localisation::parameter_drift::{ParameterDrift, ParameterShift, RecordPart};
use discrepancy::localisation::summary::Localisation;
use discrepancy::localisation::{joint, order, window_test};
use discrepancy::model::{Fit, FitSummary, FittedModel};
use discrepancy::validation::compare::{DataRole, GapRow};
use discrepancy::validation::gap_closure::gap_closure;
use discrepancy::validation::predictive::Prediction;
use discrepancy::verdict::Verdict;
use nalgebra::DVector;
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Place, Role, Sign};
use protocol::case::Case;
use protocol::pumping_unit::Sensor;
use record::noise::NoiseSource;
use record::{Curves, Record, Recorded, Stated};
use report::Origin;
use report::diagnosis::DiagnosisInput;
use search::least_squares::{LeastSquares, LeastSquaresSettings};
use search::space::Space;
use std::collections::BTreeMap;
use std::time::Duration;
use study::{DiagnosisResult, RecordedDiagnosis, StageCost};

/// Number of values in the whitened synthetic residual.
const ENTRIES: usize = 40;
/// Number of crank-angle grid points.
const GRID: usize = 360;

/// Owned sample data of a diagnosis, borrowed by the input of the diagnosis report that is made from them.
pub(crate) struct SampleDiagnosis {
    pub(crate) case: Case,
    pub(crate) diagnosed: RecordedDiagnosis,
}

impl SampleDiagnosis {
    pub(crate) fn subject(&self) -> DiagnosisInput<'_> {
        DiagnosisInput {
            case: &self.case,
            diagnosed: &self.diagnosed,
            origin: Origin {
                program: "horsehead 0.1.0".to_owned(),
                command: "horsehead diagnose cases/cyjs10-5-37hb".to_owned(),
                run: "runs/cyjs10-5-37hb-diagnose-seed1".to_owned(),
                case_hash: "3f9ad0c1b2e4".repeat(5),
                measured_name: "the case's own records".to_owned(),
                seed: Some(1),
                ..Origin::default()
            },
            assessments: Vec::new(),
            wall_s: 412.0,
        }
    }
}

fn parameter(name: &str, unit: &str, role: Role, sign: Sign) -> ParameterDescriptor {
    let shape = role == Role::Shape;
    ParameterDescriptor {
        name: name.to_owned(),
        unit: unit.to_owned(),
        role,
        sign,
        lower: if sign == Sign::Positive { 0.0 } else { -2.0 },
        upper: 2.0,
        absent: if shape { 0.3 } else { 0.0 },
        typical: 0.3,
        scale: 0.5,
    }
}

fn effect(id: &str, title: &str, parameters: Vec<ParameterDescriptor>) -> EffectDescriptor {
    EffectDescriptor {
        id: id.to_owned(),
        title: title.to_owned(),
        joint: "back_rope".to_owned(),
        place: Place::Dynamics,
        generic: false,
        parameters,
    }
}

fn library() -> Vec<EffectDescriptor> {
    let size = |unit| parameter("size", unit, Role::Size, Sign::Positive);
    let either = |unit| parameter("size", unit, Role::Size, Sign::Either);
    let mut all = vec![
        effect(
            "pin_clearance",
            "Clearance of the <pins> & their \"bores\"",
            vec![
                either("MPa"),
                parameter("turn_over", "deg", Role::Shape, Sign::Either),
            ],
        ),
        effect("gauge_drift", "Drift of the gauges", vec![either("MPa")]),
        effect("load_cell_lag", "Lag of the load cell", vec![size("s")]),
        effect(
            "rope_hysteresis",
            "Hysteresis of the ropes",
            vec![size("1")],
        ),
        effect(
            "pivot_friction",
            "Friction of the saddle bearing",
            vec![size("N m")],
        ),
        effect("gauge_gain", "Gain of the gauges", vec![either("1")]),
        effect(
            "twin_rope_inequality",
            "Unequal twin ropes",
            vec![either("m")],
        ),
        effect("beam_inertia", "Inertia of the beam", vec![either("1")]),
    ];
    let mut force = effect(
        "probe.back_head.sign",
        "Force on the head, as sgn v",
        vec![either("N")],
    );
    force.generic = true;
    all.push(force);
    all
}

/// Fits the linear model `residual = constant - A x`, with the genes and the parameters of the added effects
/// as unknowns; `size` scales the constant part of the residual.
fn fit(case: &Case, added: &[&EffectDescriptor], size: f64, curves: Curves) -> FitSummary {
    let space = Space::new(&case.unknowns).expect("the sample's genes are sound");
    let mut model = FittedModel::plain(space);
    model.added.extend(added.iter().copied().cloned());
    let variables = model.variables(&[]);
    let residual = |x: &[f64]| {
        DVector::from_fn(ENTRIES, |i, _| {
            let linear = x.iter().enumerate().map(|(k, x)| {
                let wave = ((i * (k + 2)) as f64 * 0.37).sin();
                wave * (x - 0.05 * (k as f64 - 4.0))
            });
            size * (i as f64 * 1.3).cos() / (ENTRIES as f64).sqrt() - linear.sum::<f64>()
        })
    };
    let mut search = LeastSquares::new(variables, LeastSquaresSettings::default());
    loop {
        let plan = search.plan();
        if plan.is_empty() {
            break;
        }
        search.absorb(plan.iter().map(|x| Some(residual(x))).collect());
    }
    Fit::new(model, (search, curves), None).summary()
}

const CHANNELS: [Sensor; 4] = [
    Sensor::Gauge(1),
    Sensor::Gauge(3),
    Sensor::Position,
    Sensor::Torque,
];

/// Returns a simulated curve of channel `c` that deviates from the true curve in proportion to `error`.
fn curve(c: usize, error: f64) -> Vec<f64> {
    let size = [20.0, 15.0, 1.8, 2e4][c];
    (0..GRID)
        .map(|i| {
            let turn = (i as f64).to_radians();
            let step = if (120..260).contains(&i) { 1.0 } else { -1.0 };
            size * (turn.sin() + 0.2 * (5.0 * turn + c as f64).cos() + 0.05 * error * step)
        })
        .collect()
}

fn curves(error: f64) -> Curves {
    (0..CHANNELS.len()).map(|c| curve(c, error)).collect()
}

fn record(condition: usize, cycles: usize) -> Record {
    let mut noise = sample::Noise(31 + condition as u64);
    let cycles = (0..cycles).map(|_| {
        let mut all = curves(0.0);
        for (channel, size) in all.iter_mut().zip([0.2, 0.2, 0.002, 90.0]) {
            for value in channel {
                *value += size * (noise.next() - 0.5);
            }
        }
        all
    });
    let turn_deg = (0..GRID).map(|i| 360.0 * i as f64 / GRID as f64);
    let turn_deg: Vec<f64> = turn_deg.collect();
    let recorded = |(curve, sensor): (usize, Sensor)| Recorded {
        curve,
        scored: matches!(sensor, Sensor::Gauge(_)),
        held_out: false,
        rows: None,
        correlation: None,
        model_error: None,
        channel: sensor.channel(condition, turn_deg.clone()),
    };
    Record {
        condition,
        channels: CHANNELS.into_iter().enumerate().map(recorded).collect(),
        cycles: cycles.collect(),
        held_out: false,
        stated: Stated::default(),
    }
}

fn rows(records: &[Record], after: f64) -> Vec<GapRow> {
    let split = records[0].split();
    let mut all = vec![
        (split.fitted, DataRole::Fitted),
        (split.cycles, DataRole::Cycles),
    ];
    let others = records[1..].iter().cloned();
    all.extend(others.map(|record| (record, DataRole::Condition)));
    all.retain(|(record, _)| !record.cycles.is_empty());
    all.into_iter()
        .map(|(record, part)| GapRow {
            condition: record.condition,
            part,
            held_out: false,
            closed: gap_closure(&record, &record.cycles, &curves(1.0), &curves(after)),
            before: curves(1.0),
            after: curves(after),
        })
        .collect()
}

/// Builds a candidate effect with the given p-value; a p-value of NaN stands for an effect that could not be
/// simulated.
fn suspect(
    effect: &EffectDescriptor,
    statistic: f64,
    p_value: f64,
    absorbed: f64,
) -> CandidateEffect {
    let able = p_value.is_finite();
    CandidateEffect {
        rungs: Vec::new(),
        linear: true,
        effect: effect.clone(),
        score: able.then(|| Score {
            statistic,
            freedom: 1,
            p_value,
            size: vec![if p_value < 1.0 { 0.8 } else { -0.8 }],
            deviation: vec![f64::INFINITY],
            absorbed,
        }),
        start: vec![0.0; effect.parameters.len()],
        signature: 0.01 * f64::from(u8::from(able)) * ENTRIES as f64,
        taken: vec![vec![0.0; effect.parameters.len()]; usize::from(able)],
        tries: 3,
    }
}

fn round(case: &Case, library: &[EffectDescriptor]) -> Round {
    let test = [
        (2400.0, 0.0, 0.1),
        (900.0, 1e-190, 0.3),
        (700.0, 1e-150, 0.7),
        (5.0, 0.02, 0.2),
        (60.0, 1.0, 0.4),
        (0.0, 1.0, 0.9999),
        (0.0, f64::NAN, 0.0),
        (0.2, 0.7, 0.5),
    ];
    let named = library.iter().filter(|effect| !effect.generic);
    let suspects = named
        .zip(test)
        .map(|(effect, (t, p, a))| suspect(effect, t, p, a))
        .collect();
    let generics = library
        .iter()
        .filter(|effect| effect.generic)
        .map(|effect| suspect(effect, 800.0, 1e-170, 0.2))
        .collect();
    let refit = |k: usize, size: f64, log_evidence: f64| Refitted {
        id: library[k].id.clone(),
        fit: fit(case, &[&library[k]], size, curves(0.1)),
        log_evidence,
    };
    Round {
        trace: None,
        ranked: 1,
        together: false,
        candidates: suspects,
        generics,
        refits: vec![
            refit(0, 6.0, -80.0),
            refit(1, 8.0, -84.0),
            refit(2, 20.0, -700.0),
        ],
        null_evidence: -1250.0,
        dispersion: 1.4,
        misfit: 1.4,
        p_value: 1e-250,
        set: vec![library[0].id.clone()],
        added: Some(library[0].id.clone()),
        reason: None,
    }
}

/// Abscissa bins of one crank revolution for the synthetic map of the residual along the crank angle.
const TURN: window_test::Bins = window_test::Bins {
    from: 0.0,
    width: 3.0,
    count: window_test::BINS,
    is_periodic: true,
};

fn whereabouts() -> Localisation {
    let strength = |c: usize| -> Vec<f64> {
        (0..window_test::BINS)
            .map(|b| 9.0 * ((b + 9 * c) as f64 * 0.1).sin())
            .collect()
    };
    let window = |channel, from: f64, to: f64, strength| window_test::AbscissaWindow {
        channel,
        from,
        to,
        strength,
        p_value: 1.0 / 401.0,
    };
    let ratio = |c: usize| -> Vec<f64> {
        (1..=120)
            .map(|k| 400.0 / f64::from(k) / (c + 1) as f64)
            .collect()
    };
    let evidence = |joint: &str, log_bayes| joint::JointEvidence {
        joint: joint.to_owned(),
        log_bayes,
        force: vec![joint::Harmonic {
            order: 1,
            sine: true,
            amplitude: 800.0,
        }],
        unit: "N".to_owned(),
    };
    Localisation {
        along: window_test::AlongMap {
            bins: vec![TURN; CHANNELS.len()],
            strength: (0..CHANNELS.len()).map(strength).collect(),
            windows: vec![window(0, 30.0, 93.0, 12.1), window(1, 345.0, 378.0, -9.0)],
        },
        order: order::OrderMap {
            ratio: (0..CHANNELS.len()).map(ratio).collect(),
            peaks: vec![order::Peak {
                channel: 1,
                order: 2,
                ratio: 200.0,
                p_value: 1e-20,
            }],
        },
        joints: vec![
            evidence("back_head", 210.0),
            evidence("back_rope", 205.0),
            evidence("saddle", 3.0),
            evidence("crank_pin", f64::NEG_INFINITY),
        ],
        equivalent: 2,
    }
}

fn preflight() -> Preflight {
    let each = |share: f64| [0.2, 0.2, 0.002, 90.0].map(|size| share * size).to_vec();
    Preflight {
        difference: curves(0.01),
        rms: each(0.3),
        rms_left: each(0.05),
        standard_error: each(0.1),
        left: Vec::new(),
        whole: true,
    }
}

fn limits(library: &[EffectDescriptor]) -> Vec<Limit> {
    let sizes = [0.02, 0.9, f64::INFINITY];
    let each = library.iter().zip(sizes).map(|(effect, size)| Limit {
        id: effect.id.clone(),
        parameter: "size".to_owned(),
        unit: effect.parameters[0].unit.clone(),
        size,
        largest: 1.0,
    });
    each.collect()
}

fn estimate(effect: &EffectDescriptor, value: f64, ln_evidence: f64) -> Estimate {
    let parameters = effect.parameters.iter().map(|p| {
        let (name, unit) = (p.name.clone(), p.unit.clone());
        ParameterEstimate {
            name,
            unit,
            value,
            interval: [value - 0.1, value + 0.1],
        }
    });
    Estimate {
        id: effect.id.clone(),
        title: effect.title.clone(),
        unknowns: Vec::new(),
        parameters: parameters.collect(),
        p_value: 0.0,
        ln_evidence,
    }
}

fn accounts() -> Vec<(Stage, StageCost)> {
    let account = |experiments, failed| StageCost {
        experiments,
        with_derivatives: 30,
        known: 4,
        failed,
        batches: 7,
    };
    vec![
        (Stage::Recalibrate, account(120, 0)),
        (Stage::Test, account(90, 2)),
        (Stage::Refit, account(310, 5)),
    ]
}

fn slot_times() -> BTreeMap<String, Duration> {
    let times = [
        (Stage::Recalibrate, 60),
        (Stage::Test, 40),
        (Stage::Refit, 150),
    ];
    let named =
        times.map(|(stage, seconds)| (stage.name().to_owned(), Duration::from_secs(seconds)));
    named.into()
}

/// Builds the estimate of a gauge gain error within its assumed tolerance.
fn reads_high() -> NuisanceEstimate {
    NuisanceEstimate {
        id: "gauge_gain".to_owned(),
        parameter: "gain_2".to_owned(),
        value: 0.006,
        unit: "1".to_owned(),
        interval: [0.003, 0.009],
        tolerance: 0.005,
        within: true,
        assumed: true,
    }
}

/// Builds an effect that recalibration absorbs.
fn absorbed() -> Absorbed {
    Absorbed {
        id: "post_compliance".to_owned(),
        share: 0.99,
        measurement: "kb1 known from a test of its own, or a sensor at the saddle".to_owned(),
    }
}

/// Returns the sample diagnosis' scores of predicting held-out data; empty if no effect was added.
fn predicted(added: bool) -> Vec<Prediction> {
    let one = Prediction {
        condition: 1,
        part: DataRole::Condition,
        nats: 61.2,
    };
    added.then_some(one).into_iter().collect()
}

/// Returns the remainder of an answer that explains nearly everything.
fn remainder(verdict: Verdict) -> Remainder {
    Remainder {
        explained: (verdict != Verdict::Unresolved).then_some(0.99),
        is_converged: true,
        ..Remainder::default()
    }
}

/// Builds a diagnosis with the given verdict and all data that belong to it.
pub(crate) fn diagnosis(verdict: Verdict) -> SampleDiagnosis {
    let case = sample::case();
    let library = library();
    let records = vec![record(0, 8), record(1, 8)];
    let mut round = round(&case, &library);
    let added = matches!(verdict, Verdict::Named | Verdict::Ambiguous);
    let mut effects = vec![estimate(&library[0], 0.8, 596.9)];
    match verdict {
        // far enough behind to be rejected
        Verdict::Named => round.refits[1].log_evidence = -100.0,
        Verdict::Ambiguous => {
            effects.push(estimate(&library[1], 0.7, 594.8));
            round.set.push(library[1].id.clone());
        }
        Verdict::NothingDetected | Verdict::Unlisted | Verdict::Unresolved => {
            effects.clear();
            round.set.clear();
            round.added = None;
            round.reason = Some("pin_clearance is the likeliest, but not enough".to_owned());
        }
    }
    let before = fit(&case, &[], 30.0, curves(1.0));
    let after = if added { &round.refits[0].fit } else { &before };
    let after = after.clone();
    let force = (verdict == Verdict::Unlisted).then(|| ForceEstimate {
        id: "probe.back_head.sign".to_owned(),
        joint: "back_head".to_owned(),
        form: "sign".to_owned(),
        amplitude: 420.0,
        unit: "N".to_owned(),
        interval: [380.0, 460.0],
        phase_deg: None,
        ln_evidence: 210.0,
        fit: fit(&case, &[&library[8]], 6.0, curves(0.1)),
        rows: rows(&records, 0.2),
    });
    let diagnosis = Diagnosis {
        whiteness: Some([1e-7, 0.31]),
        verdict,
        reason: (verdict == Verdict::Unresolved).then(|| "the likeliest is not enough".to_owned()),
        remainder: remainder(verdict),
        effects,
        rounds: vec![round],
        localisation: Some(whereabouts()),
        preflight: Some(preflight()),
        preflight_after: added.then(preflight),
        limits: limits(&library),
        nuisances: vec![reads_high()],
        absorbed: vec![absorbed()],
        look_alikes: vec![IndistinguishablePair {
            effects: ["pin_clearance".to_owned(), "gauge_drift".to_owned()],
            cycles: 2.4,
            cycles_with_others: Some(0.6),
        }],
        drifts: vec![wander(1e-4)],
        drifts_after: vec![wander(0.6)],
        before: Some(before),
        after: Some(after),
        rows: rows(&records, if added { 0.1 } else { 1.0 }),
        prediction: predicted(added),
        rival: added.then(|| ("load_cell_lag".to_owned(), rows(&records, 0.4))),
        generic: (verdict == Verdict::Unlisted).then(|| "probe.back_head.sign".to_owned()),
        force,
        noise: NoiseSource::Measured,
        ..Diagnosis::unresolved("")
    };
    SampleDiagnosis {
        case,
        diagnosed: RecordedDiagnosis {
            result: DiagnosisResult {
                diagnosis,
                accounts: accounts(),
                library,
                notes: vec!["The card of <5rpm> is no simultaneous measurement.".to_owned()],
            },
            records,
            slot_times: slot_times(),
            damage: Vec::new(),
        },
    }
}

/// Builds the sample drift of the first gene: doubled in the second quarter of the revolution, unchanged
/// elsewhere.
fn wander(p_value: f64) -> ParameterDrift {
    let sector = |k: usize| RecordPart::Sector {
        from: 90.0 * k as f64,
        to: 90.0 * (k + 1) as f64,
    };
    let parts = (0..4).map(sector).chain([RecordPart::Condition(1)]);
    let shift = |(k, part)| ParameterShift {
        part,
        by: if k == 1 { 2.0_f64.log10() } else { 0.0 },
        p_value: if k == 1 { p_value } else { 0.9 },
    };
    ParameterDrift {
        unknown: 0,
        shifts: parts.enumerate().map(shift).collect(),
        explained: 0.42,
    }
}

/// Builds an ambiguous diagnosis: the first round added one effect, the second an ambiguity set of two.
pub(crate) fn two_rounds() -> SampleDiagnosis {
    let mut made = diagnosis(Verdict::Ambiguous);
    let library = &made.diagnosed.result.library;
    let ids: Vec<String> = library.iter().map(|effect| effect.id.clone()).collect();
    let again = estimate(&library[2], 0.3, 12.0);
    let Diagnosis {
        rounds, effects, ..
    } = &mut made.diagnosed.result.diagnosis;
    let mut second = rounds[0].clone();
    rounds[0].set = vec![ids[0].clone()];
    second.refits.remove(0);
    second.set = vec![ids[1].clone(), ids[2].clone()];
    second.added = Some(ids[1].clone());
    rounds.push(second);
    effects.push(again);
    made
}

/// Builds a diagnosis from a record of one cycle, whose noise level is stated instead of measured: an effect
/// is suspected, but none is reported as found.
pub(crate) fn assumed() -> SampleDiagnosis {
    let mut made = diagnosis(Verdict::Unresolved);
    let suspect = estimate(&made.diagnosed.result.library[0], 0.8, 596.9);
    let diagnosis = &mut made.diagnosed.result.diagnosis;
    diagnosis.noise = NoiseSource::Stated;
    diagnosis.effects = vec![suspect];
    made
}

/// Builds a diagnosis that stopped at once, with a reason and no other data.
pub(crate) fn stopped(reason: &str) -> SampleDiagnosis {
    let mut made = diagnosis(Verdict::Unresolved);
    made.diagnosed.records = vec![record(0, 1)];
    made.diagnosed.result.accounts.clear();
    made.diagnosed.result.diagnosis = Diagnosis {
        noise: NoiseSource::Stated,
        ..Diagnosis::unresolved(reason)
    };
    made
}
