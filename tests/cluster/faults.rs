//! Tests with workers that are killed, frozen or asked to end.
use super::{LIMIT, collect, submit};
use dispatch::bench::{self, BenchPlan};
use dispatch::runtime::Dispatch;
use journal::event::JobReason;
use protocol::{id::JobId, job::Job};
use rustix::process::Signal;
use std::time::{Duration, Instant};
use tests::{
    expect_results, options,
    process::{Process, children, command_line, free_locator, is_alive, wait_until},
};

#[tokio::test(flavor = "multi_thread")]
async fn local_workers_do_all_jobs_and_are_gone_afterwards() {
    let folder = tempfile::tempdir().unwrap();
    let mut dispatch = Dispatch::open(options(folder.path(), None, 3))
        .await
        .unwrap();
    submit(&mut dispatch, 500, 3);
    let results = collect(&mut dispatch, 500, LIMIT).await.unwrap();
    expect_results(&results, 500);
    wait_until("all are shown", LIMIT, || {
        dispatch.snapshot().workers.len() == 3
    });
    let snapshot = dispatch.snapshot();
    assert_eq!((snapshot.lost, snapshot.failed), (0, 0));
    // those of this run: other tests of the suite have children, too
    let locator = dispatch.listening().remove(0);
    let mut workers = children(rustix::process::getpid());
    workers.retain(|worker| command_line(*worker).contains(&locator));
    assert_eq!(workers.len(), 3);
    let slots: Vec<_> = workers
        .iter()
        .flat_map(|worker| children(*worker))
        .collect();
    assert!(slots.len() >= 3, "{slots:?}");
    let begun = Instant::now();
    let summary = dispatch.close().await.unwrap();
    assert!(
        begun.elapsed() < LIMIT / 4,
        "closing took {:?}",
        begun.elapsed()
    );
    assert_eq!(summary.last.done, 500);
    let spent = summary.last.spent;
    assert!(
        spent.useful_us > 0 && spent.useful_us < spent.connected_us,
        "{spent:?}"
    );
    let share = spent.sum_us() as f64 / spent.connected_us as f64;
    assert!((share - 1.0).abs() < 0.01, "{share} of {spent:?}");
    // tests beside this one have slots too, for as long as they run
    wait_until("the slots are gone", LIMIT, || {
        slots.iter().all(|slot| !is_alive(*slot))
    });
}

#[tokio::test(flavor = "multi_thread")]
async fn a_killed_worker_costs_nothing_but_time() {
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    let mut dispatch = Dispatch::open(options(folder.path(), Some(&locator), 0))
        .await
        .unwrap();
    let mut victim = Process::worker(&locator, &["--slots", "2"]);
    let other = Process::worker(&locator, &["--slots", "2"]);
    submit(&mut dispatch, 60, 50);
    let first = collect(&mut dispatch, 12, LIMIT).await.unwrap();
    wait_until("the victim is busy", LIMIT, || {
        children(victim.pid()).len() == 2
    });
    let slots = children(victim.pid());
    victim.signal(Signal::KILL);
    let mut results = collect(&mut dispatch, 48, LIMIT).await.unwrap();
    results.extend(first);
    expect_results(&results, 60);
    let summary = dispatch.close().await.unwrap();
    assert_eq!(summary.last.lost, 1);
    assert!(summary.last.repeated > 0, "{:?}", summary.last);
    assert_eq!(summary.last.failed, 0);
    assert_eq!(victim.wait(LIMIT), None);
    wait_until("its slots are gone", LIMIT, || {
        slots.iter().all(|slot| !is_alive(*slot))
    });
    drop(other);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_frozen_worker_is_replaced_within_six_seconds() {
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    let mut dispatch = Dispatch::open(options(folder.path(), Some(&locator), 0))
        .await
        .unwrap();
    let frozen = Process::worker(&locator, &["--slots", "1"]);
    submit(&mut dispatch, 3, 300);
    wait_until("it is busy", LIMIT, || dispatch.snapshot().running > 0);
    frozen.signal(Signal::STOP);
    let begun = Instant::now();
    let _other = Process::worker(&locator, &["--slots", "3"]);
    let results = collect(&mut dispatch, 3, LIMIT).await.unwrap();
    let took = begun.elapsed();
    expect_results(&results, 3);
    assert!(
        took < Duration::from_secs(6),
        "all jobs were done after {took:?}"
    );
    // it wakes up, comes back and is of use again
    frozen.signal(Signal::CONT);
    wait_until("it is back", LIMIT, || {
        dispatch.snapshot().workers.len() == 2
    });
    let summary = dispatch.close().await.unwrap();
    assert_eq!((summary.last.lost, summary.last.done), (1, 3));
}

/// Checks that a frozen worker with outstanding jobs does not block the connections of the others: results
/// keep arriving while the frozen worker does not answer and is not yet declared lost.
#[tokio::test(flavor = "multi_thread")]
async fn a_frozen_worker_does_not_hold_up_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    let mut dispatch = Dispatch::open(options(folder.path(), Some(&locator), 0))
        .await
        .unwrap();
    let workers: Vec<Process> = (0..4)
        .map(|_| Process::worker(&locator, &["--slots", "2"]))
        .collect();
    wait_until("all are there", LIMIT, || {
        dispatch.snapshot().workers.len() == 4
    });
    // large orders: a pipe that nobody empties fills up
    let order = |n: u64| Job::Nothing {
        payload: vec![1; 300_000],
        reply_bytes: u32::try_from(n % 5000).unwrap(),
        delay_ms: 10,
    };
    let outstanding = 40;
    let (mut next, mut done) = (0, 0);
    let mut done_when_frozen = None;
    // until the frozen worker is declared lost
    while dispatch.snapshot().workers.len() == 4 {
        while next < done + outstanding {
            dispatch
                .submit(JobId(next), order(next), JobReason::default())
                .unwrap();
            next += 1;
        }
        tokio::time::timeout(LIMIT, dispatch.next())
            .await
            .unwrap()
            .unwrap();
        done += 1;
        if done == 200 {
            workers[0].signal(Signal::STOP);
            done_when_frozen = Some(done);
        }
    }
    let meanwhile = done - done_when_frozen.expect("no worker was lost before one was frozen");
    eprintln!("{done} results, {meanwhile} of them while a worker was frozen");
    // more than what was outstanding cannot arrive where new orders wait for the frozen worker
    assert!(
        meanwhile > 2 * outstanding,
        "{meanwhile} results while a worker was frozen"
    );
    let rest = usize::try_from(next - done).unwrap();
    collect(&mut dispatch, rest, LIMIT).await.unwrap();
    let summary = dispatch.close().await.unwrap();
    assert_eq!((summary.last.lost, summary.last.done as u64), (1, next));
    workers[0].signal(Signal::CONT);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_worker_that_is_told_to_end_gives_its_jobs_back_and_says_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    // the worker is there before the coordinator
    let mut first = Process::worker(&locator, &["--slots", "2"]);
    let mut dispatch = Dispatch::open(options(folder.path(), Some(&locator), 0))
        .await
        .unwrap();
    submit(&mut dispatch, 20, 100);
    let early = collect(&mut dispatch, 4, LIMIT).await.unwrap();
    first.signal(Signal::TERM);
    assert_eq!(first.wait(LIMIT), Some(0));
    // on a busy machine it takes seconds until its first job
    let mut idle = Process::worker(&locator, &["--slots", "4", "--idle-timeout", "10"]);
    let mut results = collect(&mut dispatch, 16, LIMIT).await.unwrap();
    results.extend(early);
    expect_results(&results, 20);
    assert_eq!(idle.wait(LIMIT), Some(0), "ends by itself without work");
    let summary = dispatch.close().await.unwrap();
    assert_eq!(
        summary.last.lost, 0,
        "nobody was lost: both said that they leave"
    );
}

#[tokio::test(flavor = "multi_thread")]
async fn the_bench_measures_the_bus() {
    let folder = tempfile::tempdir().unwrap();
    let plan = BenchPlan {
        workers: 2,
        jobs: 400,
        result_bytes: 1000,
    };
    let result = bench::measure(options(folder.path(), None, 0), plan)
        .await
        .unwrap();
    eprintln!("{result:?}");
    let trips = result.rtt_ms;
    assert!(trips.median > 0.0 && trips.median <= trips.p99);
    assert!(
        result.jobs_per_s > 50.0 && result.coordinator_rss_mib > 1.0,
        "{result:?}"
    );
}
