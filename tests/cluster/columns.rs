//! Checks that derivatives computed by several processes are bit-identical to those from one.
use super::{LIMIT, collect};
use dispatch::runtime::{Dispatch, DispatchOptions};
use protocol::{
    case::Case,
    id::{ContentHash, JobId},
    job::{Answer, Column, Derivative, Individual, Job, Outcome, Reply, SimulateSpec},
    pumping_unit::{Discretisation, PumpingUnit},
    wire,
};
use std::{collections::BTreeMap, path::Path};

/// Loads the shipped machine with longer, fewer rope cylinders, for speed.
fn coarse() -> Case {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    let case = case::load(&folder, &case::Overrides::default()).unwrap();
    let long = Discretisation {
        cylinder_length_m: Some(0.15),
        ..Discretisation::default()
    };
    let unit = PumpingUnit::of(case).unwrap();
    let unit = worker::pumping_unit::refined(&unit, &long).unwrap();
    unit.into_case().unwrap()
}

/// Returns eight simulation jobs that request derivatives with respect to a rope coefficient, an effect's
/// size, an effect's shape parameter and a generic force.
fn jobs(case: &Case) -> Vec<Job> {
    let mut shape = Column::new("pivot_friction.creep");
    shape.values = vec![("moment".to_owned(), 1500.0)];
    let effects = simulation::effect::catalogue();
    let generic = effects.iter().find(|one| one.generic).unwrap();
    let generic = format!("{}.{}", generic.id, generic.parameters[0].name);
    let columns = [
        Column::new("kb1"),
        Column::new("stuffing_box_friction.force"),
        shape,
        Column::new(generic),
    ];
    let job = |n: usize| {
        let mut genes = case.start();
        genes[n % 8] *= 1.1;
        Job::Simulate(SimulateSpec {
            columns: columns.to_vec(),
            ..SimulateSpec::new(
                Individual::new(0, genes),
                Reply::Score {
                    with_residual: true,
                    whole: true,
                },
            )
        })
    };
    (0..8).map(job).collect()
}

async fn outcomes(case: &Case, workers: usize) -> BTreeMap<JobId, Outcome> {
    let folder = tempfile::tempdir().unwrap();
    let mut options = DispatchOptions {
        pause_limit: dispatch::runtime::PAUSE_LIMIT,
        case: case.clone(),
        ..tests::options(folder.path(), None, workers)
    };
    options.header.case = ContentHash::of(&wire::encode(case).unwrap());
    let mut run = Dispatch::open(options).await.unwrap();
    let jobs = jobs(case);
    let count = jobs.len();
    for (id, job) in (0..).zip(jobs) {
        run.submit(JobId(id), job).unwrap();
    }
    let outcomes = collect(&mut run, count, LIMIT).await.unwrap();
    run.close().await.unwrap();
    outcomes
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn columns_have_the_same_bits_on_one_worker_and_on_several() {
    let case = coarse();
    let one = outcomes(&case, 1).await;
    for outcome in one.values() {
        let Outcome::Done(Answer::Scored(evaluation)) = outcome else {
            panic!("{outcome:?}")
        };
        let curves = |one: &Derivative| matches!(one, Derivative::Curves { .. });
        assert_eq!(evaluation.columns.len(), 4);
        assert!(evaluation.columns.iter().all(curves));
    }
    assert_eq!(outcomes(&case, 3).await, one);
}
