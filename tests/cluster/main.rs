//! Tests with real processes on loopback, which are killed, frozen and restarted; no result may be lost.
#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of a test suite: to panic is to fail the test"
)]
mod columns;
mod commands;
mod coordinator_kills;
mod disk;
mod faults;
mod late_reading;
mod local;
mod misbehaviour;
mod outage;
mod resume;
mod sixty_four;
mod slots;
mod wall_clock;

use dispatch::runtime::{Dispatch, DispatchError};
use journal::event::JobReason;
use protocol::{id::JobId, job::Outcome};
use std::{collections::BTreeMap, time::Duration};

const LIMIT: Duration = Duration::from_mins(1);

/// Lock for tests whose slots are children of the test process itself, so that each test counts only its own.
static OWN_SLOTS: tokio::sync::Mutex<()> = tokio::sync::Mutex::const_new(());

/// Collects the outcomes of a number of jobs from a run; panics after the time limit or at a duplicate.
async fn collect(
    dispatch: &mut Dispatch,
    jobs: usize,
    limit: Duration,
) -> Result<BTreeMap<JobId, Outcome>, DispatchError> {
    let mut results = BTreeMap::new();
    let all = async {
        while results.len() < jobs {
            let completed = dispatch.next().await?;
            let before = results.insert(completed.id, completed.outcome);
            assert_eq!(before, None, "job {} was delivered twice", completed.id);
        }
        Ok(())
    };
    let in_time = tokio::time::timeout(limit, all).await;
    match in_time {
        Ok(ended) => ended.map(|()| results),
        Err(elapsed) => panic!(
            "{elapsed}: {} of {jobs} results within {limit:?}: {:?}",
            results.len(),
            dispatch.snapshot()
        ),
    }
}

fn submit(dispatch: &mut Dispatch, jobs: u64, delay_ms: u32) {
    for n in 0..jobs {
        dispatch
            .submit(JobId(n), tests::job(n, delay_ms), JobReason::default())
            .unwrap();
    }
}
