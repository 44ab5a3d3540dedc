//! Tests of effects on the shipped pumping unit, and of jobs that contain effects.
#![expect(
    clippy::wildcard_enum_match_arm,
    clippy::too_many_lines,
    reason = "whatever else comes back is a failed test"
)]
use super::{case, run, unit};
use protocol::{
    case::{Case, EffectSetting},
    job::{Answer, Failure, Individual, Job, Observation, Outcome, Reply, SimulateSpec, Verdict},
    pumping_unit::Discretisation,
};
use simulation::effect::{Descriptor, Place, catalogue};
use worker::handler::Prepared;

/// Checks that the energy ledger (crank work = load work + losses + stored energy) closes to 1e-4 with each
/// effect that acts on the motion, at its typical size and the recommended coefficients. The longest step is
/// halved, because with the full step a worn profile reaches 1.0e-4.
#[test]
fn energy_ledger_closes_with_every_effect() {
    let unit = unit();
    let law = worker::pumping_unit::rope_law(&unit, &unit.case.start()).unwrap();
    let mut settings = worker::pumping_unit::run_settings(&unit.machine);
    settings.longest_step *= 0.5;
    let acts = |d: &&Descriptor| d.place == Place::Dynamics && !d.generic;
    for d in catalogue().iter().filter(acts) {
        let sizes = d.parameters.iter().map(|p| (p.name, p.typical));
        let typical: Vec<(&str, f64)> = sizes.collect();
        let effect = EffectSetting::new(&d.id, &typical);
        let individual = Individual {
            effects: vec![effect],
            ..Individual::new(0, unit.case.start())
        };
        let machine = worker::pumping_unit::machine_with(&unit, &individual).unwrap();
        let (result, _) = run(&machine, &law, &settings);
        let work = result.work;
        let gained = work.input - work.output - work.dissipated;
        let defect = (result.stored - gained).abs() / work.input;
        eprintln!("{}: {defect:.1e}", d.id);
        assert!(defect < 1e-4, "{}: {defect}", d.id);
    }
}

/// Reply requested from the worker: all curves, but no snapshots of the moving machine.
const CURVES: Reply = Reply::Curves { pictures: 0 };

fn observe(case: &Case, effects: &[EffectSetting], discretisation: Discretisation) -> Observation {
    let spec = SimulateSpec {
        individual: Individual {
            effects: effects.to_vec(),
            ..Individual::new(0, case.start())
        },
        numerics: discretisation.numerics().unwrap(),
        reply: Reply::Channels,
        columns: Vec::new(),
    };
    match Prepared::new(worker::SIMULATORS, case)
        .unwrap()
        .evaluate(&Job::Simulate(spec))
    {
        Outcome::Done(Answer::Channels(observation)) => observation,
        other => unreachable!("{other:?}"),
    }
}

fn bits(observation: &Observation) -> Vec<u64> {
    observation
        .curves
        .iter()
        .flatten()
        .map(|x| x.to_bits())
        .collect()
}

/// Checks that effects give the same bits whether a job or the case states them and in any order, and that
/// effects with the parameter values that stand for their absence give the bits of the machine without
/// effects.
#[test]
fn effects_give_the_same_bits_wherever_they_are_stated() {
    let case = case();
    let plain = observe(&case, &[], Discretisation::default());
    assert_eq!(plain.verdict, Verdict::Complete);
    assert_eq!(plain.curves[0].len(), 720);
    let individual = Individual {
        effects: vec![EffectSetting::new("gauge_gain", &[("gain_1", 0.0)])],
        ..Individual::new(0, case.start())
    };
    let simulate = Job::Simulate(SimulateSpec::new(individual, CURVES));
    let Outcome::Done(Answer::Curves(whole)) = Prepared::new(worker::SIMULATORS, &case)
        .unwrap()
        .evaluate(&simulate)
    else {
        unreachable!("a simulation")
    };
    let of_whole = Observation {
        verdict: whole.verdict,
        counters: whole.counters,
        curves: whole.channels,
        columns: Vec::new(),
    };
    assert_eq!(of_whole.rounded(&case, 0), plain);

    let effects = [
        EffectSetting::new("pivot_friction", &[("moment", 1500.0)]),
        EffectSetting::new("pin_clearance", &[("step_3", -1.2), ("force", 1500.0)]),
    ];
    let of_job = observe(&case, &effects, Discretisation::default());
    assert_ne!(bits(&of_job), bits(&plain));
    let mut with = case;
    with.effects = effects.iter().rev().cloned().collect();
    assert_eq!(
        bits(&observe(&with, &[], Discretisation::default())),
        bits(&of_job)
    );
    // the job's replaces the case's, absent or not
    let off = [
        EffectSetting::new("pivot_friction", &[]),
        EffectSetting::new("pin_clearance", &[]),
    ];
    assert_eq!(
        bits(&observe(&with, &off, Discretisation::default())),
        bits(&plain)
    );
}

/// Checks that a finer discretisation gives slightly different curves: gauges within 1 % of their range.
#[test]
fn a_refined_observation_is_of_the_same_machine() {
    let case = case();
    let plain = observe(&case, &[], Discretisation::default());
    let fine = observe(
        &case,
        &[],
        Discretisation {
            cylinder_length_m: Some(0.025),
            longest_step_s: Some(0.02),
            modes: Some(8),
            ..Discretisation::OF_THE_CASE
        },
    );
    assert_eq!(fine.verdict, Verdict::Complete);
    assert_ne!(bits(&fine), bits(&plain));
    for (fine, plain) in fine.curves.iter().zip(&plain.curves).take(4) {
        assert!(super::difference(fine, plain) < 0.01);
    }
}

/// Checks that unknown effects, parameters and invalid discretisations are refused with the name of the wrong
/// field, for every kind of job.
#[test]
fn what_the_model_does_not_have_is_refused_by_field() {
    let case = case();
    let prepared = Prepared::new(worker::SIMULATORS, &case).unwrap();
    let effects = vec![EffectSetting::new("pivot_friction", &[("mu", 0.1)])];
    let refused = |spec: SimulateSpec| match prepared.evaluate(&Job::Simulate(spec)) {
        Outcome::Failed(Failure::Misconfigured { field, problem }) => (field, problem),
        other => unreachable!("{other:?}"),
    };
    let plain = Individual::new(0, case.start());
    let misstated = Individual {
        effects,
        ..plain.clone()
    };
    let score = Reply::Score {
        with_residual: false,
        whole: false,
    };
    for reply in [Reply::Channels, score, CURVES] {
        let (field, problem) = refused(SimulateSpec::new(misstated.clone(), reply));
        assert_eq!(field, "effects[0].parameters.mu");
        assert!(problem.contains("has no parameter `mu`"), "{problem}");
    }
    let discretisations = [
        (
            "discretisation.cylinder_length_m",
            Discretisation {
                cylinder_length_m: Some(0.07),
                ..Discretisation::default()
            },
        ),
        (
            "discretisation.cylinder_length_m",
            Discretisation {
                cylinder_length_m: Some(f64::NAN),
                ..Discretisation::default()
            },
        ),
        (
            "discretisation.cylinder_length_m",
            Discretisation {
                cylinder_length_m: Some(1e-9),
                ..Discretisation::default()
            },
        ),
        (
            "discretisation.modes",
            Discretisation {
                modes: Some(99),
                ..Discretisation::default()
            },
        ),
        (
            "discretisation.longest_step_s",
            Discretisation {
                longest_step_s: Some(-1.0),
                ..Discretisation::default()
            },
        ),
        (
            "discretisation.tolerance",
            Discretisation {
                tolerance: Some(f64::INFINITY),
                ..Discretisation::default()
            },
        ),
    ];
    for (expected, discretisation) in discretisations {
        let spec = SimulateSpec {
            numerics: discretisation.numerics().unwrap(),
            ..SimulateSpec::new(plain.clone(), Reply::Channels)
        };
        assert_eq!(refused(spec).0, expected);
    }
    let mut misnamed = case;
    misnamed.effects = vec![EffectSetting::new("pivot_frictoin", &[])];
    let Err(Failure::Misconfigured { field, problem }) =
        Prepared::new(worker::SIMULATORS, &misnamed)
    else {
        unreachable!("accepted")
    };
    assert_eq!(field, "effects[0].id");
    assert!(
        problem.ends_with("did you mean `pivot_friction`?"),
        "{problem}"
    );
}
