//! Tests of parameters of the case's effects that are unknowns of the search: their evaluation by a worker,
//! and a calibration that recovers them.
#![expect(
    clippy::wildcard_enum_match_arm,
    reason = "whatever else comes back is a failed test"
)]
use super::unit;
use journal::event::JobReason;
use protocol::{
    case::{Case, ChannelRecord, EffectSetting, Scale, Unknown},
    id::JobId,
    job::{Answer, Failure, Individual, Job, Observation, Outcome, Reply, SimulateSpec},
    message::Cost,
    pumping_unit::Discretisation,
};
use search::space::Space;
use search::strategy::{
    Settings, build,
    levenberg::{Derivatives, DescentTolerance, LevenbergSettings},
    memetic::MemeticSettings,
    staged::{StageSettings, StagedSettings},
};
use std::collections::VecDeque;
use study::{
    Calibrated, Completed, Evaluator, EvaluatorError, ProgressView, Snapshot, Watch, calibrate,
};
use worker::handler::Prepared;

fn gene((id, parameter): (&str, &str), unit: &str, bounds: [f64; 2], value: f64) -> Unknown {
    let name = format!("{id}.{parameter}");
    Unknown {
        is_effect: true,
        ..Unknown::new(name, unit, Scale::Linear, value, bounds)
    }
}

/// Returns the shipped case with long rope cylinders and the given effects, none of whose parameters is an
/// unknown.
fn coarse(effects: &[EffectSetting]) -> Case {
    let long = Discretisation {
        cylinder_length_m: Some(0.15),
        ..Discretisation::default()
    };
    let unit = worker::pumping_unit::refined(&unit(), &long).unwrap();
    let mut case = unit.into_case().unwrap();
    case.effects = effects.to_vec();
    case
}

fn friction(moment: f64) -> EffectSetting {
    EffectSetting::new("pivot_friction", &[("creep", 0.004), ("moment", moment)])
}

fn moment() -> Unknown {
    gene(("pivot_friction", "moment"), "N.m", [200.0, 4000.0], 1000.0)
}

/// Returns the case with the saddle bearing's friction moment as an additional unknown.
fn searched(case: &Case) -> Case {
    let mut case = case.clone();
    case.unknowns.push(moment());
    case
}

/// Returns an individual with the start values of all coefficients and the given friction moment.
fn individual(case: &Case, moment: f64) -> Vec<f64> {
    let mut genes = case.start();
    genes[10] = moment;
    genes
}

fn observed(prepared: &Prepared, genes: &[f64], effects: &[EffectSetting]) -> Observation {
    let individual = Individual {
        condition: 0,
        genes: genes.to_vec(),
        effects: effects.to_vec(),
    };
    let spec = SimulateSpec::new(individual, Reply::Channels);
    match prepared.evaluate(&Job::Simulate(spec)) {
        Outcome::Done(Answer::Channels(observation)) => observation,
        other => unreachable!("{other:?}"),
    }
}

/// Checks that an effect's parameter among an individual's values gives the same bits as the same value
/// written into the case, for every kind of job, and that no state is carried from one individual to the
/// next. An effect stated in the job replaces that of the case entirely, including its searched parameter.
#[test]
fn a_gene_of_an_effect_is_that_value_in_the_case() {
    let (stated, other) = (coarse(&[friction(1000.0)]), coarse(&[friction(1800.0)]));
    let with_gene = Prepared::new(worker::SIMULATORS, &searched(&stated)).unwrap();
    let at = |moment: f64| individual(&searched(&stated), moment);
    let fixed = [&stated, &other].map(|case| Prepared::new(worker::SIMULATORS, case).unwrap());
    let genes = stated.start();
    let [low, high] = fixed
        .each_ref()
        .map(|prepared| observed(prepared, &genes, &[]));
    assert_ne!(low.curves, high.curves);
    for (moment, expected) in [(1800.0, &high), (1000.0, &low), (1800.0, &high)] {
        assert_eq!(&observed(&with_gene, &at(moment), &[]), expected);
    }
    let jobs = |genes: Vec<f64>| {
        let score = Reply::Score {
            with_residual: true,
            whole: true,
        };
        let curves = Reply::Curves { pictures: 0 };
        [score, curves].map(|reply| {
            let individual = Individual::new(0, genes.clone());
            Job::Simulate(SimulateSpec::new(individual, reply))
        })
    };
    let [score, simulate] = jobs(genes.clone());
    let [scored, simulated] = jobs(at(1800.0));
    assert_eq!(with_gene.evaluate(&scored), fixed[1].evaluate(&score));
    let curves = |outcome: Outcome| match outcome {
        Outcome::Done(Answer::Curves(curves)) => curves.channels,
        other => unreachable!("{other:?}"),
    };
    assert_eq!(
        curves(with_gene.evaluate(&simulated)),
        curves(fixed[1].evaluate(&simulate))
    );
    let own = [EffectSetting::new("pivot_friction", &[("moment", 300.0)])];
    assert_eq!(
        observed(&with_gene, &at(1800.0), &own),
        observed(&fixed[0], &genes, &own)
    );
}

/// Checks that an invalid searched parameter of an effect is refused with the name of its field: wrong bounds
/// or units when the case is prepared, wrong values when the individual is evaluated.
#[test]
fn a_gene_that_the_model_cannot_take_is_refused_by_field() {
    let refused = |failure: Failure| match failure {
        Failure::Misconfigured { field, problem } => (field, problem),
        other => unreachable!("{other:?}"),
    };
    let stated = coarse(&[friction(1000.0)]);
    let faults = [
        (
            gene(("gauge_drift", "drift_1"), "MPa/rev", [0.0, 1.0], 0.5),
            ("genes.gauge_drift.drift_1", "the case has no effect"),
        ),
        (
            gene(("pivot_friction", "momment"), "N.m", [0.0, 1.0], 0.5),
            (
                "effects[0].parameters.momment.search",
                "did you mean `moment`?",
            ),
        ),
        (
            gene(("pivot_friction", "moment"), "N.m", [-100.0, 2e3], 1e3),
            (
                "effects[0].parameters.moment.search",
                "must lie between 0 and 30000 N.m",
            ),
        ),
        (
            gene(("pivot_friction", "viscous"), "N.m", [0.0, 2e3], 1e3),
            ("genes.pivot_friction.viscous.unit", "takes it in N.m.s/rad"),
        ),
    ];
    for (gene, (field, problem)) in faults {
        let mut case = stated.clone();
        case.unknowns.push(gene);
        let (found, why) = refused(Prepared::new(worker::SIMULATORS, &case).unwrap_err());
        assert_eq!(found, field);
        assert!(why.contains(problem), "{why}");
    }
    let case = searched(&stated);
    let prepared = Prepared::new(worker::SIMULATORS, &case).unwrap();
    for (genes, field) in [
        (individual(&case, -1.0), "effects[0].parameters.moment"),
        (individual(&case, f64::NAN), "effects[0].parameters.moment"),
        (stated.start(), "genes"),
    ] {
        let reply = Reply::Score {
            with_residual: false,
            whole: true,
        };
        let job = Job::Simulate(SimulateSpec::new(Individual::new(0, genes), reply));
        let Outcome::Failed(failure) = prepared.evaluate(&job) else {
            unreachable!("accepted")
        };
        assert_eq!(refused(failure).0, field);
    }
}

/// Evaluator that runs jobs sequentially in this process, as a slot does.
struct LocalEvaluator {
    prepared: Prepared,
    waiting: VecDeque<(JobId, Job)>,
}

impl Evaluator for LocalEvaluator {
    fn submit(&mut self, id: JobId, job: Job, _reason: JobReason) -> Result<(), EvaluatorError> {
        self.waiting.push_back((id, job));
        Ok(())
    }

    async fn next(&mut self) -> Result<Completed, EvaluatorError> {
        let Some((id, job)) = self.waiting.pop_front() else {
            return std::future::pending().await;
        };
        Ok(Completed {
            id,
            cost: Cost::default(),
            outcome: self.prepared.evaluate(&job),
            replayed: false,
        })
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot::default()
    }
}

struct Unseen;

impl Watch<ProgressView> for Unseen {
    fn progress(&mut self, _: &ProgressView, _: &dyn Fn() -> Snapshot) {}
}

fn calibrated(case: &Case, parts: Vec<StageSettings>) -> Calibrated {
    let space = Space::new(&case.unknowns).unwrap();
    let trust = space.axes().iter().map(|axis| axis.trust).collect();
    let settings = Settings::of(&StagedSettings { trust, parts });
    let mut strategy = build(&settings, &space, 1).unwrap();
    let mut here = LocalEvaluator {
        prepared: Prepared::new(worker::SIMULATORS, case).unwrap(),
        waiting: VecDeque::new(),
    };
    let (_keep, mut stop) = tokio::sync::watch::channel(false);
    let runtime = tokio::runtime::Builder::new_current_thread().build();
    let mut unseen = Unseen;
    let search = calibrate(&mut here, case, strategy.as_mut(), &mut unseen, &mut stop);
    runtime.unwrap().block_on(search).unwrap()
}

/// Checks that a calibration with fewer than 150 individuals recovers the hidden friction and load-card delay
/// of a synthetic record, among all coefficients.
#[test]
fn a_calibration_finds_the_sizes_of_effects() {
    let late = |time: f64| EffectSetting::new("card_time_shift", &[("time", time)]);
    let (hidden_moment, hidden_time) = (2500.0, -0.012);
    let truth = coarse(&[friction(hidden_moment), late(hidden_time)]);
    let seen = observed(
        &Prepared::new(worker::SIMULATORS, &truth).unwrap(),
        &truth.start(),
        &[],
    );
    let mut case = searched(&coarse(&[friction(1000.0), late(0.0)]));
    let time = gene(("card_time_shift", "time"), "s", [-0.04, 0.04], 0.0);
    case.unknowns.push(time);
    for (channel, curve) in case.channels.iter_mut().zip(&seen.curves).take(4) {
        channel.record = Some(ChannelRecord {
            cycles: 1,
            mean: curve.clone(),
            spread: vec![0.0; curve.len()],
        });
    }
    let found = calibrated(
        &case,
        vec![
            StageSettings::Memetic(MemeticSettings {
                population: 4,
                generations: 1,
                crossover_trials: 1,
                mutation_trials: 1,
                ..MemeticSettings::paper()
            }),
            StageSettings::LeastSquares(LevenbergSettings {
                starts: 1,
                iterations: 5,
                apart: 0.03,
                step: 0.01,
                longest: 100.0,
                level: 0.0,
                heat: 100,
                keep: 1,
                derivatives: Derivatives::Exact,
                finish: DescentTolerance::Usual,
            }),
        ],
    );
    let first = found.log.entries().next().unwrap().fitness;
    let [.., moment, time] = found.best.genes[..] else {
        unreachable!("no genes")
    };
    eprintln!(
        "{} individuals: {first:.3e} to {:.3e} MPa2, friction {moment:.1} N.m, card {time:.5} s late",
        found.log.len(),
        found.best.fitness
    );
    assert!(found.log.len() < 150);
    assert!(found.best.fitness < 0.01 * first);
    assert!((moment - hidden_moment).abs() < 0.1 * (hidden_moment - 1000.0));
    assert!((time - hidden_time).abs() < 0.1 * hidden_time.abs());
}
