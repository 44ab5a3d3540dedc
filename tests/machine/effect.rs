//! Effects on the real unit, and jobs that ask for them.
#![expect(
    clippy::wildcard_enum_match_arm,
    clippy::too_many_lines,
    reason = "whatever else comes back is a failed test"
)]
use super::{case, run};
use protocol::case::{Case, EffectSetting};
use protocol::job::{
    Failure, Job, Observation, ObserveSpec, Outcome, Refinement, ScoreSpec, SimulateSpec, Verdict,
};
use simulation::effect::{Descriptor, Place, catalogue};
use worker::handler::Prepared;

/// Crank work is load work, losses and stored energy with each effect that acts on the motion, at its
/// typical size and the recommended coefficients: to 1e-4 with half the longest step (with the whole, a
/// worn profile comes to 1.0e-4).
#[test]
fn energy_ledger_closes_with_every_effect() {
    let case = case();
    let law = worker::convert::rope_law(&case, &case.recommended()).unwrap();
    let mut settings = worker::convert::run_settings(&case);
    settings.longest_step *= 0.5;
    let acts = |d: &&Descriptor| d.place == Place::Dynamics && !d.generic;
    for d in catalogue().iter().filter(acts) {
        let sizes = d.parameters.iter().map(|p| (p.name, p.typical));
        let typical: Vec<(&str, f64)> = sizes.collect();
        let effect = EffectSetting::new(&d.id, &typical);
        let machine =
            worker::convert::machine_with(&case, 0, (&case.recommended(), &[effect])).unwrap();
        let (result, _) = run(&machine, &law, &settings);
        let work = result.work;
        let gained = work.input - work.output - work.dissipated;
        let defect = (result.stored - gained).abs() / work.input;
        eprintln!("{}: {defect:.1e}", d.id);
        assert!(defect < 1e-4, "{}: {defect}", d.id);
    }
}

fn observe(case: &Case, effects: &[EffectSetting], refinement: Refinement) -> Observation {
    let spec = ObserveSpec {
        condition: 0,
        genes: case.recommended(),
        effects: effects.to_vec(),
        refinement,
    };
    match Prepared::new(case).unwrap().evaluate(&Job::Observe(spec)) {
        Outcome::Observed(observation) => observation,
        other => unreachable!("{other:?}"),
    }
}

fn bits(observation: &Observation) -> Vec<u64> {
    let gauges = observation.gauge_mpa.iter().flatten();
    let all = gauges.chain(&observation.suspension_m);
    all.chain(&observation.crank_torque_n_m)
        .map(|x| x.to_bits())
        .collect()
}

/// A job's effects, the same effects in the case, and in another order: the same bits. At their
/// absent values: those of the plain machine, which are those of a whole simulation.
#[test]
fn effects_give_the_same_bits_wherever_they_are_stated() {
    let case = case();
    let plain = observe(&case, &[], Refinement::default());
    assert_eq!(plain.verdict, Verdict::Complete);
    assert_eq!(plain.gauge_mpa[0].len(), 720);
    let simulate = Job::Simulate(SimulateSpec {
        integration: None,
        condition: 0,
        genes: case.recommended(),
        effects: vec![EffectSetting::new("gauge_gain", &[("gain_1", 0.0)])],
        motion_step_deg: 0.0,
    });
    let Outcome::Simulated(whole) = Prepared::new(&case).unwrap().evaluate(&simulate) else {
        unreachable!("a simulation")
    };
    assert_eq!(whole.gauge_mpa, plain.gauge_mpa);
    assert_eq!(whole.suspension_m, plain.suspension_m);
    assert_eq!(whole.crank_torque_n_m, plain.crank_torque_n_m);

    let effects = [
        EffectSetting::new("pivot_friction", &[("moment", 1500.0)]),
        EffectSetting::new("pin_clearance", &[("step_3", -1.2), ("force", 1500.0)]),
    ];
    let of_job = observe(&case, &effects, Refinement::default());
    assert_ne!(bits(&of_job), bits(&plain));
    let mut with = case;
    with.effects = effects.iter().rev().cloned().collect();
    assert_eq!(
        bits(&observe(&with, &[], Refinement::default())),
        bits(&of_job)
    );
    // the job's replaces the case's, absent or not
    let off = [
        EffectSetting::new("pivot_friction", &[]),
        EffectSetting::new("pin_clearance", &[]),
    ];
    assert_eq!(
        bits(&observe(&with, &off, Refinement::default())),
        bits(&plain)
    );
}

/// Another discretisation is near, and not the same.
#[test]
fn a_refined_observation_is_of_the_same_machine() {
    let case = case();
    let plain = observe(&case, &[], Refinement::default());
    let fine = observe(
        &case,
        &[],
        Refinement {
            lead_in_deg: None,
            cylinder_length_m: Some(0.025),
            longest_step_s: Some(0.02),
            modes: Some(8),
            tolerance: None,
        },
    );
    assert_eq!(fine.verdict, Verdict::Complete);
    assert_ne!(bits(&fine), bits(&plain));
    for (fine, plain) in fine.gauge_mpa.iter().zip(&plain.gauge_mpa) {
        assert!(super::difference(fine, plain) < 0.01);
    }
}

/// What a worker cannot do is named by its field, whichever kind of job asks for it.
#[test]
fn what_the_model_does_not_have_is_refused_by_field() {
    let case = case();
    let prepared = Prepared::new(&case).unwrap();
    let genes = case.recommended();
    let effects = vec![EffectSetting::new("pivot_friction", &[("mu", 0.1)])];
    let refused = |job: Job| match prepared.evaluate(&job) {
        Outcome::Failed(Failure::Misconfigured { field, problem }) => (field, problem),
        other => unreachable!("{other:?}"),
    };
    let observe = ObserveSpec {
        genes: genes.clone(),
        effects: effects.clone(),
        ..ObserveSpec::default()
    };
    let jobs = [
        Job::Observe(observe.clone()),
        Job::Score(ScoreSpec {
            condition: 0,
            genes: genes.clone(),
            effects: effects.clone(),
            with_residual: false,
        }),
        Job::Simulate(SimulateSpec {
            integration: None,
            condition: 0,
            genes,
            effects,
            motion_step_deg: 0.0,
        }),
    ];
    for job in jobs {
        let (field, problem) = refused(job);
        assert_eq!(field, "effects[0].parameters.mu");
        assert!(problem.contains("has no parameter `mu`"), "{problem}");
    }
    let refinements = [
        (
            "refinement.cylinder_length_m",
            Refinement {
                cylinder_length_m: Some(0.07),
                ..Refinement::default()
            },
        ),
        (
            "refinement.cylinder_length_m",
            Refinement {
                cylinder_length_m: Some(f64::NAN),
                ..Refinement::default()
            },
        ),
        (
            "refinement.cylinder_length_m",
            Refinement {
                cylinder_length_m: Some(1e-9),
                ..Refinement::default()
            },
        ),
        (
            "refinement.modes",
            Refinement {
                modes: Some(99),
                ..Refinement::default()
            },
        ),
        (
            "refinement.longest_step_s",
            Refinement {
                longest_step_s: Some(-1.0),
                ..Refinement::default()
            },
        ),
        (
            "refinement.tolerance",
            Refinement {
                tolerance: Some(f64::INFINITY),
                ..Refinement::default()
            },
        ),
    ];
    for (expected, refinement) in refinements {
        let spec = ObserveSpec {
            effects: Vec::new(),
            refinement,
            ..observe.clone()
        };
        assert_eq!(refused(Job::Observe(spec)).0, expected);
    }
    let mut misnamed = case;
    misnamed.effects = vec![EffectSetting::new("pivot_frictoin", &[])];
    let Err(Failure::Misconfigured { field, problem }) = Prepared::new(&misnamed) else {
        unreachable!("accepted")
    };
    assert_eq!(field, "effects[0].id");
    assert!(
        problem.ends_with("did you mean `pivot_friction`?"),
        "{problem}"
    );
}
