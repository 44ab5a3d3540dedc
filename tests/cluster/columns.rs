//! Checks that derivatives computed by several processes are bit-identical to those from one.
use super::{LIMIT, collect};
use dispatch::runtime::{Dispatch, DispatchOptions};
use journal::event::JobReason;
use protocol::{
    case::Case,
    id::JobId,
    job::{Answer, Column, Derivative, Individual, Job, Outcome, Reply, SimulateSpec},
    pumping_unit::{Discretisation, PumpingUnit},
};
use std::{collections::BTreeMap, path::Path, sync::Arc, time::Duration};
use study::ColumnDivision;

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

fn options(case: &Case, folder: &Path, workers: usize) -> DispatchOptions {
    let settings = "{}".to_owned();
    DispatchOptions {
        divide: Arc::new(ColumnDivision::of(case)),
        ..DispatchOptions::local(folder, workers, case, "test", settings).unwrap()
    }
}

async fn outcomes(case: &Case, workers: usize) -> BTreeMap<JobId, Outcome> {
    let folder = tempfile::tempdir().unwrap();
    let mut run = Dispatch::open(options(case, folder.path(), workers))
        .await
        .unwrap();
    let jobs = jobs(case);
    let count = jobs.len();
    for (id, job) in (0..).zip(jobs) {
        run.submit(JobId(id), job, JobReason::default()).unwrap();
    }
    let outcomes = collect(&mut run, count, LIMIT).await.unwrap();
    run.close().await.unwrap();
    outcomes
}

/// Checks that jobs computed ahead have the same bits, that their slot time counts as useful once they are
/// submitted, and that the run ends without those that are never submitted.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn what_is_computed_ahead_has_the_same_bits() {
    let case = coarse();
    let expected = outcomes(&case, 1).await;
    let folder = tempfile::tempdir().unwrap();
    let mut run = Dispatch::open(options(&case, folder.path(), 3))
        .await
        .unwrap();
    let jobs = jobs(&case);
    run.submit(JobId(0), jobs[0].clone(), JobReason::default())
        .unwrap();
    let mut outcomes = collect(&mut run, 1, LIMIT).await.unwrap();
    run.anticipate(jobs[1..4].to_vec()).unwrap();
    let wait_until_idle = async |run: &Dispatch| {
        let is_done = || {
            let snapshot = run.snapshot();
            snapshot.spent.speculative_us > 0 && snapshot.running == 0
        };
        tokio::time::timeout(LIMIT, async {
            while !is_done() {
                tokio::time::sleep(Duration::from_millis(20)).await;
            }
        })
        .await
        .unwrap();
        run.snapshot().spent
    };
    let ahead = wait_until_idle(&run).await;
    // the first of them was divided for three idle slots: one job of two parts
    run.submit(JobId(1), jobs[1].clone(), JobReason::default())
        .unwrap();
    outcomes.extend(collect(&mut run, 1, LIMIT).await.unwrap());
    tokio::time::sleep(Duration::from_millis(50)).await;
    let claimed = run.snapshot().spent;
    assert!(claimed.speculative_us < ahead.speculative_us, "{claimed:?}");
    assert!(claimed.useful_us > ahead.useful_us, "{claimed:?}");
    for (id, job) in (2..).zip(&jobs[2..]) {
        run.submit(JobId(id), job.clone(), JobReason::default())
            .unwrap();
    }
    run.anticipate(vec![jobs[0].clone()]).unwrap();
    outcomes.extend(collect(&mut run, 6, LIMIT).await.unwrap());
    run.close().await.unwrap();
    assert_eq!(outcomes, expected);
    // the journal has the submitted jobs alone
    let run = Dispatch::open(options(&case, folder.path(), 1))
        .await
        .unwrap();
    assert_eq!(run.recorded(), 8);
    run.close().await.unwrap();
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
