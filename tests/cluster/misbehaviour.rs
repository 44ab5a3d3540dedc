//! Tests with jobs that crash, allocate without bound, never return, leave processes behind or kill their
//! worker: each is terminated and reported, and the other jobs are done.
use super::{OWN_SLOTS, collect};
use dispatch::{
    runtime::{Completed, Dispatch, DispatchError, RunSummary},
    scheduler::StopReason,
};
use journal::event::JobReason;
use protocol::{
    id::{AttemptId, JobId},
    job::{Answer, Failure, Outcome},
    message::Attempt,
};
use std::{
    collections::BTreeMap,
    fs,
    path::Path,
    process::Command,
    time::{Duration, Instant},
};
use tests::{
    job, options,
    process::{Process, free_locator, wait_until},
};
use tokio::sync::mpsc::unbounded_channel;
use worker::pool::{Pool, SlotOptions, Task};

/// Time limit of every wait; longer than elsewhere, since workers start slowly on a busy machine.
const LIMIT: Duration = Duration::from_mins(3);

/// Returns the outcomes of jobs 0 to `jobs` - 1 on workers with the given misbehaving jobs, and the run's
/// summary.
async fn outcomes(
    jobs: u64,
    behaviour: &str,
    workers: usize,
) -> (BTreeMap<JobId, Outcome>, RunSummary) {
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    let mut dispatch = Dispatch::open(options(folder.path(), Some(&locator), 0))
        .await
        .unwrap();
    let environment = [("HORSEHEAD_TEST_MISBEHAVE", behaviour)];
    let arguments = ["--slots", "2", "--slot-memory", "1024"];
    let workers: Vec<Process> = (0..workers)
        .map(|_| Process::worker_with(&locator, &arguments, &environment))
        .collect();
    for n in 0..jobs {
        dispatch
            .submit(JobId(n), job(n, 5), JobReason::default())
            .unwrap();
    }
    let results = collect(&mut dispatch, usize::try_from(jobs).unwrap(), LIMIT)
        .await
        .unwrap();
    let summary = dispatch.close().await.unwrap();
    drop(workers);
    (results, summary)
}

#[tokio::test(flavor = "multi_thread")]
async fn jobs_that_crash_or_allocate_without_bound_fail_alone_and_say_why() {
    let (results, summary) = outcomes(40, "7:abort,8:allocate", 1).await;
    let mut failed: BTreeMap<u64, String> = BTreeMap::new();
    for (id, outcome) in &results {
        if let Outcome::Failed(failure @ Failure::Crashed { .. }) = outcome {
            failed.insert(id.0, failure.to_string());
        }
    }
    assert_eq!(failed.keys().copied().collect::<Vec<_>>(), [7, 8]);
    for words in failed.values() {
        assert!(
            words.contains("signal 6") && words.contains("1024 MiB"),
            "{words}"
        );
    }
    assert_eq!((summary.last.failed, summary.last.lost), (2, 0));
    assert_eq!(summary.last.repeated, 2, "each was tried twice");
}

/// Checks that a job that kills its workers runs alone after two losses and waits for a worker that joins after four, that
/// no other job fails, and that the run ends without a result for it and is resumed by a healthy worker.
#[tokio::test(flavor = "multi_thread")]
async fn a_job_that_kills_its_workers_is_quarantined_and_computed_when_the_run_is_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    let mut run = options(folder.path(), Some(&locator), 0);
    run.pause_limit = Duration::from_secs(2);
    let arguments = ["--slots", "2"];
    let workers: Vec<Process> = (0..6)
        .map(|_| {
            let environment = [("HORSEHEAD_TEST_MISBEHAVE", "3:kill-worker")];
            Process::worker_with(&locator, &arguments, &environment)
        })
        .collect();
    let mut results = BTreeMap::new();
    for is_resumed in [false, true] {
        let mut dispatch = Dispatch::open(run.clone()).await.unwrap();
        let healthy = is_resumed.then(|| Process::worker_with(&locator, &arguments, &[]));
        for n in 0..30 {
            dispatch
                .submit(JobId(n), job(n, 5), JobReason::default())
                .unwrap();
        }
        let ended = tokio::time::timeout(LIMIT, async {
            while results.len() < 30 {
                let completed = dispatch.next().await?;
                results.insert(completed.id, completed.outcome);
            }
            Ok(())
        });
        match ended.await.unwrap() {
            Ok(()) => assert!(is_resumed),
            Err(DispatchError::Stopped(StopReason::WorkersLost { job, workers, .. })) => {
                // a worker that joined late counts as new
                assert!((4..=6).contains(&workers), "{workers} workers");
                assert_eq!((job, is_resumed), (JobId(3), false));
                assert_eq!(results.len(), 29);
            }
            Err(error) => panic!("{error}"),
        }
        let summary = dispatch.close().await.unwrap();
        if !is_resumed {
            assert_eq!(summary.last.failed, 0);
            assert!(
                (4..=6).contains(&summary.last.lost),
                "{}",
                summary.last.lost
            );
        }
        drop(healthy);
    }
    let done = |it: &&Outcome| matches!(it, Outcome::Done(Answer::Nothing(_)));
    assert_eq!(results.values().filter(done).count(), 30);
    drop(workers);
}

/// Creates options of a slot with misbehaving jobs. The slot is started by a shell script that sets its
/// environment, since a test must not change the environment of its own process.
fn slot(folder: &Path, behaviour: &str, by: &str) -> SlotOptions {
    let program = folder.join("worker");
    let worker = tests::process::worker_program();
    let script = format!(
        "#!/bin/sh\nHORSEHEAD_TEST_MISBEHAVE={behaviour} exec {by} {} \"$@\"\n",
        worker.display()
    );
    fs::write(&program, script).unwrap();
    let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    fs::set_permissions(&program, mode).unwrap();
    SlotOptions {
        program,
        memory_mib: 0,
    }
}

fn task(n: u64, deadline: Duration) -> Task {
    Task {
        attempt: Attempt {
            job: JobId(n),
            attempt: AttemptId(1),
        },
        deadline,
        job: Box::new(job(n, 0)),
        case: None,
    }
}

/// Checks that a job is terminated at its deadline with all its descendants, even those outside its process
/// group.
#[test]
fn a_job_that_never_returns_leaves_no_descendant() {
    let _turn = OWN_SLOTS.blocking_lock();
    let (to, mut freed) = unbounded_channel();
    let folder = tempfile::tempdir().unwrap();
    let options = slot(folder.path(), "1:orphan,2:hang,3:spin", "");
    let pool = Pool::start(1, &options, &to).unwrap();
    for n in 1..=3 {
        // the process is there and waits: the time of its start is not what is measured
        pool.run(0, task(0, LIMIT));
        assert!(freed.blocking_recv().is_some());
        let deadline = Duration::from_millis(1500);
        let begun = Instant::now();
        pool.run(0, task(n, deadline));
        if n == 1 {
            wait_until("the orphan is there", LIMIT, || sleepers() == 1);
        }
        let outcome = freed.blocking_recv().unwrap().outcome;
        let ended = begun.elapsed();
        assert_eq!(outcome, Some(Outcome::Failed(Failure::deadline(1500))));
        eprintln!("job {n} was ended after {ended:?}");
        // one that computes is given the time that others had its processor
        assert!(n == 3 || ended < deadline + LIMIT, "{ended:?}");
        wait_until("no descendant is left", LIMIT, || sleepers() == 0);
    }
    drop(pool);
}

/// Counts the `sleep` processes left behind by the misbehaving job.
fn sleepers() -> usize {
    let processes = fs::read_dir("/proc").into_iter().flatten().flatten();
    let ours = format!("HORSEHEAD_SLOT_PROCESS={}.", std::process::id());
    processes
        .filter(|process| {
            let read = |name| fs::read(process.path().join(name)).unwrap_or_default();
            let environment = String::from_utf8_lossy(&read("environ")).into_owned();
            read("cmdline").starts_with(b"sleep\0") && environment.contains(&ours)
        })
        .count()
}

/// Checks that a run in which every job crashes stops with one clear message instead of a thousand.
#[tokio::test(flavor = "multi_thread")]
async fn if_every_job_crashes_the_run_stops_with_one_message() {
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    let mut dispatch = Dispatch::open(options(folder.path(), Some(&locator), 0))
        .await
        .unwrap();
    let behaviour: Vec<String> = (0..40).map(|n| format!("{n}:abort")).collect();
    let behaviour = behaviour.join(",");
    let environment = [("HORSEHEAD_TEST_MISBEHAVE", behaviour.as_str())];
    let _worker = Process::worker_with(&locator, &["--slots", "4"], &environment);
    for n in 0..40 {
        dispatch
            .submit(JobId(n), job(n, 0), JobReason::default())
            .unwrap();
    }
    let stopped = tokio::time::timeout(LIMIT, async {
        loop {
            match dispatch.next().await {
                Ok(Completed { outcome, .. }) => {
                    assert!(matches!(outcome, Outcome::Failed(_)), "{outcome:?}");
                }
                Err(error) => return error.to_string(),
            }
        }
    });
    let message = stopped.await.unwrap();
    assert!(
        message.starts_with("the first 8 jobs all failed"),
        "{message}"
    );
    dispatch.close().await.unwrap();
}

/// Checks that a job that waits for a processor is not terminated at its deadline. On a busy machine
/// computing may take ten times as long, and the result of a run must not depend on the machine's load.
#[test]
fn a_job_that_gets_no_processor_is_not_overdue() {
    let _turn = OWN_SLOTS.blocking_lock();
    let busy: Vec<Process> = (0..2)
        .map(|_| {
            let mut command = Command::new("taskset");
            command.args(["-c", "0", "sh", "-c", "while :; do :; done"]);
            Process::start(command)
        })
        .collect();
    let (to, mut freed) = unbounded_channel();
    let folder = tempfile::tempdir().unwrap();
    let options = slot(folder.path(), "2:burn", "taskset -c 0 nice -n 10");
    let pool = Pool::start(1, &options, &to).unwrap();
    // its process starts slowly, too
    pool.run(0, task(1, LIMIT));
    assert!(matches!(
        freed.blocking_recv().unwrap().outcome,
        Some(Outcome::Done(Answer::Nothing(_)))
    ));
    let deadline = Duration::from_millis(500);
    pool.run(0, task(2, deadline));
    let done = freed.blocking_recv().unwrap();
    let [wall, cpu] = [done.cost.wall_us, done.cost.cpu_us].map(Duration::from_micros);
    eprintln!("{cpu:?} of computing took {wall:?}");
    assert!(wall > deadline, "it was not short of anything: {done:?}");
    let burnt = Duration::from_millis(100);
    assert!(
        (burnt / 2..wall).contains(&cpu),
        "waiting is not computing: {done:?}"
    );
    assert!(
        matches!(done.outcome, Some(Outcome::Done(Answer::Nothing(_)))),
        "{done:?}"
    );
    drop((pool, busy));
}
