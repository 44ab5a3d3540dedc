//! Peers that mean no good: rubbish, lies and silence, against a coordinator at work.
//!
//! What they cost is counted and shown (run with `--nocapture`); what is asserted is that nothing is
//! lost, nothing false is believed, and whoever lies is told in what.
#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of a test suite: to panic is to fail the test"
)]
mod bytes;
mod idle;
mod words;

use dispatch::runtime::Dispatch;
use protocol::{id::JobId, job::Outcome};
use rustix::process::Pid;
use std::{
    collections::BTreeMap,
    time::{Duration, Instant},
};

const LIMIT: Duration = Duration::from_mins(1);

/// Who measures writes and is alone, so that the numbers mean something; the others read.
static MEASURING: tokio::sync::RwLock<()> = tokio::sync::RwLock::const_new(());

/// Processor time of a process: this one, where the coordinator is in it \[us\].
fn processor_us(of: Pid) -> u64 {
    const TICK_US: u64 = 10_000;
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", of.as_raw_nonzero()));
    let stat = stat.unwrap_or_default();
    let behind = stat.rsplit_once(')').map_or("", |(_, rest)| rest);
    let ticks = behind.split_whitespace().skip(11).take(2);
    let ticks: u64 = ticks.filter_map(|word| word.parse::<u64>().ok()).sum();
    ticks * TICK_US
}

/// Does jobs until a time is over, and returns how many a second.
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
                .submit(JobId(submitted), tests::job(submitted, 2))
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
