//! Synthesised case with results: machine geometry, plausible curves and a search log.
use crate::geometry::{self, Pose};
use journal::account::{JobCost, Presence, PresenceMark};
use journal::event::{Spent, WorkerAccount};
use protocol::pumping_unit::failure;
use protocol::{
    case::{Case, Channel, ChannelRecord, Condition, Objective, Term, Unknown},
    id::WorkerId,
    job::{ChannelScore, Counters, Curves, Evaluation, Reached, Verdict},
    pumping_unit::{
        BackHead, Beam, Coefficient, Contact, Crank, Energy, FrontHead, HeadLoads, Influence,
        LoadCard, Machine, ModalHead, Rod, RopeEnds, Ropes, RunSettings, Sensor, Simulation,
        Smoothing, Suspension, TurnSense, WorkingCondition,
    },
    unit::Unit,
};
use report::{
    Calibration, ConditionResult, HistoryPoint, Individual, Origin, ScoredCurves, SingleRun,
};

/// Number of crank-angle points per revolution in the sample simulation.
const GRID: usize = 720;
/// Harmonics of the polished-rod load \[kN\]: cosine and sine amplitude.
const LOAD_KN: [(f64, f64); 10] = [
    (-8.017, 14.245),
    (0.473, 0.671),
    (-2.036, -2.740),
    (-0.503, -0.059),
    (1.341, -0.033),
    (0.340, -0.159),
    (-0.712, 0.537),
    (-0.176, 0.453),
    (0.969, -1.083),
    (0.703, -0.560),
];

/// Deterministic pseudo-random numbers (64-bit mixer), uniform in 0..1.
pub(crate) struct Noise(pub u64);

impl Noise {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn load_n(turn_deg: f64) -> f64 {
    let harmonics = (1..).zip(LOAD_KN).map(|(n, (a, b))| {
        let (sin, cos) = (f64::from(n) * turn_deg.to_radians()).sin_cos();
        a * cos + b * sin
    });
    1e3 * (57.553 + harmonics.sum::<f64>())
}

fn gene(name: Coefficient, unit: Unit, recommended: f64) -> Unknown {
    let bounds = [1e-4 * recommended, 1e4 * recommended];
    case::pumping_unit::unknown(name, unit, recommended, bounds)
}

fn genes() -> Vec<Unknown> {
    use Unit::{
        NewtonMetrePerDegree as Bend, NewtonMetreSecondPerDegree as BendRate,
        NewtonPerMetre as Stiff, NewtonPerMetreToThreeHalves as Hertz,
        NewtonSecondPerMetre as Damp,
    };
    vec![
        gene(Coefficient::Kb1, Stiff, 3.14e8),
        gene(Coefficient::Kb23, Stiff, 1.25e8),
        gene(Coefficient::Kb4, Bend, 110.0),
        gene(Coefficient::Kb56, Bend, 137.0),
        gene(Coefficient::Cb1, Damp, 400.0),
        gene(Coefficient::Cb23, Damp, 400.0),
        gene(Coefficient::Cb4, BendRate, 40.0),
        gene(Coefficient::Cb56, BendRate, 40.0),
        gene(Coefficient::Kc, Hertz, 1e6),
        gene(Coefficient::Cc, Damp, 50.0),
    ]
}

/// Builds a sample machine whose head has no vibration modes.
#[expect(clippy::too_many_lines, reason = "one literal, field by field")]
fn machine() -> Machine {
    let turn_deg: Vec<f64> = (0..GRID).map(|i| 0.5 * i as f64).collect();
    let working = |speed_rpm: f64| WorkingCondition {
        speed_rpm,
        counterweight_moment_n_m: 106_200.0,
        card: LoadCard {
            turn_deg: turn_deg.clone(),
            load_n: turn_deg.iter().map(|&turn| load_n(turn)).collect(),
            smoothing: Smoothing::None,
        },
    };
    Machine {
        gravity_m_s2: 9.81,
        beam: Beam {
            inertia_kg_m2: 2.4e4,
            gravity_moment_n_m: 0.0,
            gravity_height_moment_n_m: 0.0,
        },
        crank: Crank {
            center_x_m: -2.6,
            center_y_m: -5.1,
            radius_m: 1.0973,
            sense: TurnSense::Clockwise,
            counterweight_phase_deg: 0.0,
            reducer_rating_n_m: Some(37.0e3),
            counterweights: None,
        },
        rod: Rod {
            length_m: 2.876,
            mass_kg: 450.0,
            center_of_mass_m: 2.04,
            inertia_kg_m2: 385.0,
        },
        suspension: Suspension { mass_kg: 170.0 },
        ropes: Ropes {
            diameter_m: 0.01,
            cylinder_length_m: 0.05,
            density_kg_m3: 7850.0,
            reference_length_m: 0.05,
            ends: RopeEnds::HalfPitch,
            preload_n: 0.0,
            back_cylinders: 72,
            front_cylinders: 114,
        },
        contact: Contact {
            exponent: 1.5,
            full_damping_penetration_m: 1e-4,
        },
        front_head: FrontHead {
            radius_m: 3.6,
            rope_anchor_deg: 36.6,
        },
        back_head: BackHead {
            radius_m: 1.9,
            center_x_m: -0.15,
            center_y_m: -0.58,
            rope_anchor_deg: 125.0,
        },
        twin_ropes: None,
        modal_head: ModalHead {
            frequencies_hz: Vec::new(),
            damping_ratio: 0.01,
            arc_deg: vec![118.0, 169.0, 220.0],
            radial: Vec::new(),
            tangential: Vec::new(),
            gauge_stress_mpa: Vec::new(),
            participation: Vec::new(),
            stress: protocol::pumping_unit::StressRecovery::ModeAcceleration,
            inertia_stress_mpa: [[0.0; 4]; 3],
            mass_kg: 881.0,
            influence: Influence {
                psi_deg: Vec::new(),
                normal_mpa_per_n: Vec::new(),
                tangential_mpa_per_n: Vec::new(),
            },
        },
        conditions: vec![working(5.0), working(4.0)],
        run: RunSettings {
            output_step_deg: 0.5,
            lead_in_deg: 30.0,
            ramp_s: 2.0,
            integrator: protocol::pumping_unit::Integrator::Esdirk4,
            longest_step_s: 0.03,
            tolerance: 1.0,
            modes: 6,
            iteration_budget: 25_000,
        },
    }
}

pub(crate) fn case() -> Case {
    let machine = machine();
    Case {
        name: "CYJS10-5-37HB <test & sample>".to_owned(),
        model: machine.settings().expect("settings that fit"),
        effects: Vec::new(),
        effect_units: Vec::new(),
        unknowns: genes(),
        conditions: ["5rpm", "4rpm"]
            .map(|name| Condition {
                name: name.to_owned(),
            })
            .into(),
        channels: (0..2)
            .flat_map(|condition| channels(&machine, condition))
            .collect(),
        objective: Objective {
            condition: 0,
            others: Vec::new(),
            terms: [1, 3].map(term).into(),
        },
    }
}

/// Returns the rope tension at the crossbeam \[N\].
fn tension_n(machine: &Machine, pose: &Pose) -> f64 {
    load_n(pose.turn_deg) * machine.front_head.radius_m / pose.arm_m
}

/// Returns the stress at a gauge [`MPa`]: similar in shape to that of the real head, with a rope vibration of
/// amplitude `ripple` and order `order`.
fn stress_mpa(machine: &Machine, pose: &Pose, gauge: usize, ripple: f64, order: f64) -> f64 {
    let psi = (pose.normal_rad - pose.beam_rad).to_degrees();
    let tension_kn = 1e-3 * tension_n(machine, pose);
    let (gain, tilt, zero) = [
        (-0.30, 0.16, -28.0),
        (0.17, -0.10, 22.0),
        (0.34, 0.20, -26.0),
        (-0.14, 0.12, -10.0),
    ][gauge];
    let vibration = ripple * (order * pose.turn_deg).to_radians().sin() * (tension_kn / 148.0);
    zero + gain * tension_kn + tilt * (psi - 170.0) + vibration
}

fn term(gauge: u8) -> Term {
    Term {
        channel: Sensor::Gauge(gauge).name(),
        weight: 1.0,
    }
}

/// Builds the channels of a condition of the sample case, with measured records for the strain gauges.
fn channels(machine: &Machine, condition: usize) -> Vec<Channel> {
    let mut noise = Noise(17 + condition as u64);
    let poses = geometry::revolution(machine, GRID);
    let turn_deg: Vec<f64> = poses.iter().map(|pose| pose.turn_deg).collect();
    let mut channels: Vec<Channel> = Sensor::ALL
        .map(|sensor| sensor.channel(condition, turn_deg.clone()))
        .into();
    for (gauge, channel) in channels.iter_mut().take(4).enumerate() {
        let mean = poses.iter().map(|pose| {
            let stress = stress_mpa(machine, pose, gauge, 0.5, 61.0);
            stress + 0.3 * (noise.next() - 0.5) + 0.4 * condition as f64
        });
        let spread = poses
            .iter()
            .map(|pose| 0.35 + 0.25 * pose.turn_deg.to_radians().sin().powi(2));
        channel.record = Some(ChannelRecord {
            cycles: 5,
            mean: mean.collect(),
            spread: spread.collect(),
        });
    }
    channels
}

/// Builds a complete simulation whose stress differs from the sample record in proportion to `error` (1 is
/// large).
#[expect(clippy::too_many_lines, reason = "one literal, field by field")]
pub(crate) fn simulation(case: &Case, error: f64, motion_step_deg: f64) -> Simulation {
    let machine = &Machine::of(case).expect("a pumping unit");
    let poses = geometry::revolution(machine, GRID);
    let angular = |speed_rpm: f64| speed_rpm * 6.0;
    let per_second = angular(5.0) * GRID as f64 / 360.0;
    let height: Vec<f64> = poses
        .iter()
        .map(|pose| geometry::suspension_y_m(machine, pose) + 5.4)
        .collect();
    let slope = |values: &[f64]| -> Vec<f64> {
        (0..GRID)
            .map(|i| {
                let (after, before) = (values[(i + 1) % GRID], values[(i + GRID - 1) % GRID]);
                0.5 * (after - before) * per_second
            })
            .collect()
    };
    let velocity = slope(&height);
    let acceleration = slope(&velocity);
    let tension: Vec<f64> = poses
        .iter()
        .map(|pose| {
            tension_n(machine, pose)
                * (1.0 + 0.03 * error * (55.0 * pose.turn_deg).to_radians().sin())
        })
        .collect();
    let load: Vec<f64> = poses.iter().map(|pose| load_n(pose.turn_deg)).collect();
    let gauge = |index: usize| -> Vec<f64> {
        poses
            .iter()
            .map(|pose| {
                let exact = stress_mpa(
                    machine,
                    pose,
                    index,
                    0.5 + 5.0 * error,
                    57.0 + 4.0 / (1.0 + error),
                );
                exact * (1.0 + 0.25 * error) + 3.0 * (1.0 + error)
            })
            .collect()
    };
    let every = (motion_step_deg * GRID as f64 / 360.0).round().max(1.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small positive number of grid steps"
    )]
    let every = every as usize;
    Simulation {
        verdict: Verdict::Complete,
        counters: Counters {
            steps: 312,
            rejected_steps: 9,
            newton_iterations: 2251,
            jacobians: 118,
            factorizations: 402,
        },
        wall_s: 0.187,
        turn_deg: poses.iter().map(|pose| pose.turn_deg).collect(),
        gauge_mpa: [gauge(0), gauge(1), gauge(2), gauge(3)],
        back_rope_tension_n: tension.clone(),
        front_rope_tension_n: load.clone(),
        tension_difference_n: [Vec::new(), Vec::new()],
        beam_deg: poses
            .iter()
            .map(|pose| pose.beam_rad.to_degrees())
            .collect(),
        crank_torque_n_m: (0..GRID)
            .map(|i| {
                let turn = poses[i].turn_deg.to_radians();
                load[i] * velocity[i] / angular(5.0).to_radians() - 106_200.0 * turn.sin()
            })
            .collect(),
        suspension_m: height,
        suspension_velocity_m_s: velocity,
        suspension_acceleration_m_s2: acceleration,
        modal: (1..=6)
            .map(|mode| {
                let curve = tension.iter();
                curve.map(|pull| 1e-9 * f64::from(mode) * pull).collect()
            })
            .collect(),
        head_loads: HeadLoads::default(),
        energy: Energy {
            input_j: 92_310.0,
            output_j: 91_800.0,
            dissipated_j: 498.0,
            stored_j: 11.0,
            relative_error: 1.1e-5,
        },
        motion: poses
            .iter()
            .zip(tension.iter().zip(&load))
            .step_by(every)
            .map(|(pose, (&back, &front))| geometry::snapshot(machine, pose, back, front))
            .collect(),
    }
}

/// Truncates a simulation to `points` samples, as a failure during the revolution would.
pub(crate) fn fail(simulation: &mut Simulation, points: usize) {
    simulation.verdict = Verdict::Failed {
        kind: failure::ROPE_THROUGH_HEAD,
        reached: Reached::TimeFraction(0.34),
    };
    simulation.turn_deg.truncate(points);
    for curve in simulation.gauge_mpa.iter_mut().chain([
        &mut simulation.back_rope_tension_n,
        &mut simulation.front_rope_tension_n,
        &mut simulation.beam_deg,
        &mut simulation.suspension_m,
        &mut simulation.suspension_velocity_m_s,
        &mut simulation.suspension_acceleration_m_s2,
        &mut simulation.crank_torque_n_m,
    ]) {
        curve.truncate(points);
    }
    let last = simulation.turn_deg.last().copied().unwrap_or(-1.0);
    simulation.motion.retain(|motion| motion.turn_deg <= last);
}

/// Scores a simulation against the sample record of a condition, with an unoptimised implementation.
pub(crate) fn score(case: &Case, condition: usize, simulation: &Simulation) -> Evaluation {
    let complete = simulation.verdict == Verdict::Complete;
    let measured = case.measured(condition).filter(|_| complete);
    let channels: Vec<ChannelScore> = measured
        .map(|(at, channel, record)| {
            channel_score(at, &record.mean, simulation.channel(&channel.name))
        })
        .collect();
    let weighted = case.objective.terms.iter().map(|term| {
        let mut channels = channels.iter();
        let found = channels.find(|score| case.channels[score.channel].name == term.channel);
        found.map_or(0.0, |score| term.weight * score.mse)
    });
    Evaluation {
        verdict: simulation.verdict,
        fitness: if complete { weighted.sum() } else { 1.66e6 },
        channels,
        residual: Vec::new(),
        columns: Vec::new(),
        counters: simulation.counters,
    }
}

fn channel_score(channel: usize, measured: &[f64], simulated: &[f64]) -> ChannelScore {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let pairs = measured.iter().zip(simulated);
    let difference: Vec<f64> = pairs.map(|(m, s)| m - s).collect();
    let offset = mean(&difference);
    let square = |shift: f64| {
        let squares: Vec<f64> = difference.iter().map(|d| (d - shift).powi(2)).collect();
        mean(&squares)
    };
    let span = |values: &[f64]| {
        let high = values.iter().copied().fold(f64::MIN, f64::max);
        high - values.iter().copied().fold(f64::MAX, f64::min)
    };
    let middle = mean(measured);
    let deviation: Vec<f64> = measured.iter().map(|m| (m - middle).abs()).collect();
    let error: Vec<f64> = difference.iter().map(|d| (d - offset).abs()).collect();
    ChannelScore {
        channel,
        mse: square(offset),
        mse_fixed_offset: square(0.0),
        offset,
        rmse_over_half_range: square(offset).sqrt() / (0.5 * span(measured)),
        relative_error: mean(&error) / mean(&deviation),
        peak_to_peak_error: span(simulated) / span(measured) - 1.0,
    }
}

pub(crate) fn run(case: &Case, condition: usize, error: f64) -> ScoredCurves {
    let simulation = simulation(case, error, if condition == 0 { 2.0 } else { 0.0 });
    ScoredCurves {
        evaluation: score(case, condition, &simulation),
        curves: curves(case, condition, simulation),
    }
}

/// Converts a simulation to the curves that a worker sends.
pub(crate) fn curves(case: &Case, condition: usize, simulation: Simulation) -> Curves {
    let channels = case.channels_of(condition);
    let channels = channels.map(|(_, channel)| simulation.channel(&channel.name).to_vec());
    let channels = channels.collect();
    simulation.into_curves(channels).expect("curves that fit")
}

/// Modifies the simulation of a run under the calibrated condition, and scores the run again.
pub(crate) fn change(case: &Case, run: &mut ScoredCurves, change: impl FnOnce(&mut Simulation)) {
    let mut simulation = Simulation::of(&run.curves).expect("a pumping unit");
    change(&mut simulation);
    run.evaluation = score(case, 0, &simulation);
    run.curves = curves(case, 0, simulation);
}

/// Returns the simulation cost of the individual with an index: twice as high for every hundredth, and
/// slightly increasing with the index.
fn cost(index: usize) -> JobCost {
    let slow = if index % 100 == 7 { 2.0 } else { 1.0 };
    let processor_s = 0.2 * slow + 1e-6 * index as f64;
    JobCost {
        wall_s: 1.5 * processor_s,
        processor_s,
        newton_iterations: 2000,
    }
}

/// Builds a search log whose population converges to `best` over the generations.
fn history(case: &Case, best: &[f64], count: usize) -> Vec<HistoryPoint> {
    let mut noise = Noise(5);
    (0..count)
        .map(|index| {
            let progress = index as f64 / count as f64;
            let width = 4.0 * (1.0 - progress).powi(2) + 0.15;
            let genes: Vec<f64> = case
                .unknowns
                .iter()
                .zip(best)
                .map(|(gene, &best)| {
                    let normal = (0..6).map(|_| noise.next() - 0.5).sum::<f64>();
                    let decades = best.log10() + width * normal;
                    let (low, high) = (gene.lower.log10(), gene.upper.log10());
                    10_f64.powf(decades.clamp(low, high))
                })
                .collect();
            let weights = [0.5, 0.04, 0.0, 0.1, 0.2, 0.02, 0.0, 0.05, 0.3, 0.1];
            let misfit: f64 = genes
                .iter()
                .zip(best)
                .zip(weights)
                .map(|((gene, best), weight)| weight * (gene / best).log10().abs())
                .sum();
            let complete = noise.next() > 0.5 * (misfit / 1.5).min(1.2);
            let fitness = 0.75 + 18.0 * misfit.powf(1.3);
            HistoryPoint {
                id: index as u64,
                generation: u32::try_from(index / 80).expect("few generations"),
                purpose: "offspring".to_owned(),
                genes,
                fitness: if complete { fitness } else { 1e6 + fitness },
                complete,
                failure: (!complete).then(|| "overstretched_rope".to_owned()),
                cost: Some(cost(index)),
            }
        })
        .collect()
}

fn origin() -> Origin {
    Origin {
        program: "horsehead 0.1.0".to_owned(),
        command: "horsehead calibrate cases/cyjs10-5-37hb --preset paper --seed 7".to_owned(),
        run: "cyjs10-5-37hb-7".to_owned(),
        case_hash: "3f9ad0c1b2e4".repeat(5),
        measured_name: "the case's own records".to_owned(),
        preset: Some("paper".to_owned()),
        seed: Some(7),
        synthetic: false,
        digest: "9b1d77aa03c2".repeat(5),
    }
}

/// Builds a successful calibration whose recommended parameters are far from the optimum.
pub(crate) fn calibration(evaluations: usize) -> Calibration {
    let case = case();
    let factors = [2.49, 1.81, 1.85, 2.25, 13.0, 10.7, 1.1, 1.4, 401.0, 20.4];
    let genes: Vec<f64> = case
        .unknowns
        .iter()
        .zip(factors)
        .map(|(gene, factor)| factor * gene.start)
        .collect();
    let mut conditions: Vec<ConditionResult> = (0..2)
        .map(|condition| ConditionResult {
            condition,
            recommended: run(&case, condition, 1.0),
            optimised: run(&case, condition, 0.08 + 0.05 * condition as f64),
        })
        .collect();
    let mut history = history(&case, &genes, evaluations);
    if let Some(last) = history.last_mut() {
        last.genes.clone_from(&genes);
        last.fitness = conditions[0].optimised.evaluation.fitness;
        last.complete = true;
    }
    // one gauge that the fit made worse, so that the report has something to admit
    conditions[1].optimised.evaluation.channels[3].mse =
        1.2 * conditions[1].recommended.evaluation.channels[3].mse;
    Calibration {
        identifiability: Vec::new(),
        rivals: Vec::new(),
        assessments: Vec::new(),
        origin: origin(),
        recommended: Individual {
            id: None,
            genes: case.start(),
        },
        optimised: Individual {
            id: evaluations.checked_sub(1).map(|id| id as u64),
            genes,
        },
        history,
        workers: (0..3)
            .map(|index| WorkerAccount {
                worker: WorkerId(index),
                host: format!("node-{index:02}"),
                slots: 2,
                done: 1600 + 41 * index,
                failed: index / 2,
                spent: Spent {
                    connected_us: 600_000_000,
                    useful_us: 520_000_000 - 60_000_000 * index,
                    ..Spent::default()
                },
            })
            .collect(),
        presence: (0..3).map(presence).collect(),
        // three workers of two slots for 300 s each
        spent: Spent {
            connected_us: 1_800_000_000,
            useful_us: 1_380_000_000,
            barrier_us: 340_000_000,
            starved_us: 50_000_000,
            speculative_us: 20_000_000,
            failed_us: 10_000_000,
            lost_us: 0,
        },
        wall_s: 304.0,
        finish: "the last generation was reached".to_owned(),
        conditions,
        notes: vec!["The load card of 5rpm is not a simultaneous measurement.".to_owned()],
        case,
    }
}

/// Builds the presence of a worker that joins later the higher its index, and of which an attempt fails.
fn presence(index: u64) -> Presence {
    let mark = |minute: u64| PresenceMark {
        at_s: 60.0 * minute as f64,
        connected_s: 60.0 * minute as f64 - 20.0 * index as f64,
        useful_share: 0.3 * index as f64,
        failed: u64::from(minute > 3) * index,
    };
    Presence {
        worker: WorkerId(index),
        host: format!("node-{index:02}"),
        marks: (1..=5).map(mark).collect(),
    }
}

/// Builds one simulation with the recommended parameters.
pub(crate) fn single() -> SingleRun {
    let case = case();
    let simulation = simulation(&case, 0.3, 2.0);
    SingleRun {
        origin: Origin {
            preset: None,
            seed: None,
            command: "horsehead simulate cases/cyjs10-5-37hb".to_owned(),
            ..origin()
        },
        condition: 0,
        genes_name: "recommended".to_owned(),
        genes: case.start(),
        evaluation: Some(score(&case, 0, &simulation)),
        curves: curves(&case, 0, simulation),
        derived: Vec::new(),
        notes: Vec::new(),
        case,
    }
}
