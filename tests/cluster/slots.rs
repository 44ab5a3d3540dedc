//! Tests of slots with jobs that never return, slots that crash, and a link that loses, duplicates and
//! reorders messages.
use super::{LIMIT, OWN_SLOTS};
use dispatch::runtime::Dispatch;
use link::memory::{FaultInjection, Hub};
use protocol::{
    id::{JobId, WorkerId},
    job::{Answer, Failure, Job},
    message::Attempt,
};
use rustix::process::{Signal, getpid, kill_process};
use std::{
    collections::BTreeSet,
    time::{Duration, Instant},
};
use tests::{
    options,
    process::{children, command_line, is_alive, wait_until, worker_program},
    search_run::SearchRun,
};
use tokio::sync::mpsc::unbounded_channel;
use worker::{
    SIMULATORS,
    pool::{Freed, Pool, SlotOptions, Task},
    session::{self, Ending, SessionOptions},
};

fn slot_options() -> SlotOptions {
    SlotOptions {
        program: worker_program(),
        memory_mib: 0,
    }
}

fn task(job: u64, delay_ms: u32, deadline: Duration) -> Task {
    let attempt = Attempt {
        job: JobId(job),
        ..Attempt {
            job: JobId(0),
            attempt: protocol::id::AttemptId(1),
        }
    };
    let job = Box::new(Job::Nothing {
        payload: Vec::new(),
        reply_bytes: 3,
        delay_ms,
    });
    Task {
        attempt,
        deadline,
        job,
        case: None,
    }
}

/// Returns the slot processes that are children of this test process; tests that use it run one at a time,
/// and the slots of other tests are children of worker processes.
fn slots() -> BTreeSet<i32> {
    children(getpid())
        .into_iter()
        .filter(|pid| command_line(*pid).get(1).is_some_and(|word| word == "slot"))
        .map(|pid| pid.as_raw_nonzero().get())
        .collect()
}

fn failure(freed: Freed) -> Failure {
    match freed.outcome {
        Some(protocol::job::Outcome::Failed(failure)) => failure,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_job_that_never_returns_is_ended_and_a_crash_is_told() {
    let _turn = OWN_SLOTS.blocking_lock();
    let (to, mut freed) = unbounded_channel();
    let pool = Pool::start(1, &slot_options(), &to).unwrap();
    let before = slots();
    pool.run(0, task(1, 600_000, Duration::from_millis(400)));
    let begun = Instant::now();
    wait_until("the slot's process is there", LIMIT, || {
        slots().difference(&before).count() == 1
    });
    let ended = failure(freed.blocking_recv().unwrap());
    assert_eq!(ended, Failure::deadline(400));
    assert!(begun.elapsed() < LIMIT, "{:?}", begun.elapsed());
    wait_until("it is gone", LIMIT, || {
        slots().difference(&before).count() == 0
    });

    pool.run(0, task(2, 600_000, LIMIT));
    wait_until("the next one is there", LIMIT, || {
        slots().difference(&before).count() == 1
    });
    let pid = *slots().difference(&before).next().unwrap();
    let pid = rustix::process::Pid::from_raw(pid).unwrap();
    kill_process(pid, Signal::KILL).unwrap();
    let crashed = failure(freed.blocking_recv().unwrap());
    assert!(
        matches!(&crashed, Failure::Crashed { how, .. } if how.contains("ended by signal 9")),
        "{crashed:?}"
    );

    pool.run(0, task(3, 600_000, LIMIT));
    pool.cancel(0, task(3, 0, LIMIT).attempt);
    assert_eq!(freed.blocking_recv().unwrap().outcome, None, "cancelled");
    pool.run(0, task(4, 0, LIMIT));
    let done = freed.blocking_recv().unwrap();
    assert_eq!(
        done.outcome,
        Some(protocol::job::Outcome::Done(Answer::Nothing(vec![0; 3])))
    );
    assert!(pool.is_alive());
    drop(pool);
    assert!(!is_alive(pid));
    wait_until("the slots are gone", LIMIT, || {
        slots().difference(&before).count() == 0
    });
}

/// Runs a search over an in-process link with injected faults; returns the search log and the run's summary.
async fn over_memory(faults: FaultInjection) -> (String, dispatch::runtime::RunSummary) {
    let folder = tempfile::tempdir().unwrap();
    let mut hub = None;
    let made = Dispatch::over(&options(folder.path(), None, 0), |_, blob| {
        let (end, place) = Hub::new(faults, blob);
        hub = Some(place);
        end
    });
    let mut dispatch = made.unwrap();
    let hub = hub.unwrap();
    let mut workers = Vec::new();
    for id in 1..=3 {
        let options = SessionOptions {
            simulators: SIMULATORS,
            id: WorkerId(id),
            slots: 2,
            program: worker_program(),
            slot_memory_mib: 0,
            idle_timeout: None,
            embedded: true,
            status: std::sync::Arc::default(),
        };
        workers.push(tokio::spawn(session::run(
            hub.worker(WorkerId(id)),
            options,
            tokio::time::sleep(LIMIT),
        )));
    }
    let mut search = SearchRun::of(3, 5, 1);
    search.run(&mut dispatch, |_| {}).await;
    let summary = dispatch.close().await.unwrap();
    for worker in workers {
        let ending = worker.await.unwrap().unwrap();
        assert!(
            matches!(ending, Ending::RunOver | Ending::Unlinked),
            "{ending:?}"
        );
    }
    (search.log(), summary)
}

/// Checks that a link that loses a fifth of all messages, duplicates a fifth and reorders all gives the same
/// search, to the last bit of every individual.
#[tokio::test(flavor = "multi_thread")]
async fn a_link_that_loses_doubles_and_reorders_changes_nothing() {
    let _turn = OWN_SLOTS.lock().await;
    let (clean, summary) = over_memory(FaultInjection::NONE).await;
    assert!(clean.lines().count() > 80, "{clean}");
    assert_eq!((summary.last.repeated, summary.last.duplicates), (0, 0));
    for seed in [1, 2] {
        let delay = Duration::from_millis(30);
        let faults = FaultInjection {
            seed,
            loss: 0.2,
            duplication: 0.2,
            delay,
        };
        let (faulty, summary) = over_memory(faults).await;
        assert_eq!(faulty, clean, "seed {seed}");
        assert!(
            summary.last.duplicates > 0,
            "seed {seed}: {:?}",
            summary.last
        );
    }
}
