//! Benchmark with jobs that only sleep, on sessions of a separate process: runs a source of jobs to its end
//! on more slots than there are processors.
use super::{meter::processor_time, sessions::Connections};
use crate::{
    runtime::{dispatch::Dispatch, error::DispatchError, listen, options::DispatchOptions},
    simulated::JobSource,
};
use journal::event::{JobReason, Spent};
use protocol::{id::JobId, job::Job};
use std::time::{Duration, Instant};
use tokio::time::sleep;

/// Time limit for sessions to join.
const JOINING: Duration = Duration::from_mins(3);

/// Result of a benchmark with jobs that only sleep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SleepingJobsResult {
    /// Number of sessions that joined.
    pub slots: usize,
    /// Wall-clock time from the first job to the end of the job source.
    pub wall: Duration,
    /// Processor time of the coordinator from the first job to the end of the job source.
    pub processor: Duration,
    /// Number of results received.
    pub results: u64,
    /// Accounts of slot time before the first job, and at the end of the job source.
    pub spent: [Spent; 2],
}

/// Runs a source of jobs on a number of one-slot sessions over a Unix socket; each job sleeps for the time
/// given by `takes`.
///
/// # Errors
/// As [`Dispatch::open`] and [`Dispatch::next`].
pub async fn sleep_through(
    mut options: DispatchOptions,
    slots: usize,
    source: &mut dyn JobSource,
    takes: &dyn Fn(u64) -> Duration,
) -> Result<SleepingJobsResult, DispatchError> {
    let (folder, socket) = listen::local_socket().map_err(DispatchError::Socket)?;
    options.listen = Some(socket.to_string());
    let mut dispatch = Dispatch::open(options).await?;
    let at = dispatch.listening().into_iter().next().unwrap_or_default();
    let sessions = Connections::start(slots, &at, None).map_err(DispatchError::Start)?;
    let opened = Instant::now();
    while dispatch.snapshot().workers.len() < slots && opened.elapsed() < JOINING {
        sleep(Duration::from_millis(5)).await;
    }
    let (begun, processor, before) = (Instant::now(), processor_time(), dispatch.snapshot());
    let (mut results, mut open) = (0, 0_usize);
    let sleeping = |(number, job): (u64, Job)| {
        let delay = takes(number).as_millis();
        delayed(job, u32::try_from(delay).unwrap_or(u32::MAX))
    };
    while !source.is_done() {
        for (id, job) in source.ask(slots.saturating_sub(open)) {
            open += 1;
            dispatch.submit(JobId(id), sleeping((id, job)), JobReason::default())?;
        }
        let anticipated = source.anticipate(slots.saturating_sub(open));
        dispatch.anticipate(anticipated.into_iter().map(sleeping).collect())?;
        let done = dispatch.next().await?;
        results += 1;
        open -= 1;
        source.tell(done.id.0, &done.outcome);
    }
    let slept = SleepingJobsResult {
        slots: before.workers.len(),
        wall: begun.elapsed(),
        processor: processor_time().saturating_sub(processor),
        results,
        spent: [before.spent, dispatch.snapshot().spent],
    };
    dispatch.close().await?;
    drop((sessions, folder));
    Ok(slept)
}

fn delayed(job: Job, delay: u32) -> Job {
    match job {
        Job::Nothing {
            payload,
            reply_bytes,
            delay_ms: _,
        } => Job::Nothing {
            payload,
            reply_bytes,
            delay_ms: delay,
        },
        other @ (Job::Simulate(_) | Job::Own { .. } | Job::Describe) => other,
    }
}
