//! Tests with hostile peers, which send invalid bytes, false messages or nothing, against a working
//! coordinator.
//!
//! The cost of the attacks is measured and printed (run with `--nocapture`); the tests assert that no result
//! is lost, no forged result is accepted, and a peer with a wrong announcement is told which field is wrong.
#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of a test suite: to panic is to fail the test"
)]
mod bytes;
mod idle;
mod words;

use dispatch::runtime::Dispatch;
use journal::event::JobReason;
use protocol::{id::JobId, job::Outcome};
use rustix::process::Pid;
use std::{
    collections::BTreeMap,
    time::{Duration, Instant},
};

const LIMIT: Duration = Duration::from_mins(1);

/// Lock that lets a measuring test run alone (write lock), while other tests run concurrently (read lock).
static MEASURING: tokio::sync::RwLock<()> = tokio::sync::RwLock::const_new(());

/// Returns the processor time used by a process, which may be this one if it contains the coordinator \[us\].
fn processor_us(of: Pid) -> u64 {
    const TICK_US: u64 = 10_000;
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", of.as_raw_nonzero()));
    let stat = stat.unwrap_or_default();
    let behind = stat.rsplit_once(')').map_or("", |(_, rest)| rest);
    let ticks = behind.split_whitespace().skip(11).take(2);
    let ticks: u64 = ticks.filter_map(|word| word.parse::<u64>().ok()).sum();
    ticks * TICK_US
}

/// Runs jobs for the given time and returns the number of results per second.
async fn rate(
    dispatch: &mut Dispatch,
    results: &mut BTreeMap<JobId, Outcome>,
    time: Duration,
) -> f64 {
    // enough that everybody has something to do, and no more
    const AHEAD: u64 = 64;
    let begun = Instant::now();
    let mut submitted = results.len() as u64;
    let before = submitted;
    loop {
        while begun.elapsed() < time && submitted < results.len() as u64 + AHEAD {
            dispatch
                .submit(
                    JobId(submitted),
                    tests::job(submitted, 2),
                    JobReason::default(),
                )
                .unwrap();
            submitted += 1;
        }
        if results.len() as u64 == submitted {
            break;
        }
        let completed = tokio::time::timeout(LIMIT, dispatch.next()).await;
        let completed = completed.unwrap().unwrap();
        let twice = results.insert(completed.id, completed.outcome);
        assert_eq!(twice, None, "job {} was delivered twice", completed.id);
    }
    (submitted - before) as f64 / begun.elapsed().as_secs_f64()
}
