//! The bus alone: jobs that do nothing, over real workers and a real journal.
use super::{Dispatch, DispatchError, DispatchOptions};
use protocol::{id::JobId, job::Job};
use std::{
    fs,
    time::{Duration, Instant},
};

/// Bytes of a job on its way to a worker, about those of a gene vector with its frame.
const JOB_BYTES: usize = 1000;
/// Bytes of a result, about those of a residual vector.
const RESULT_BYTES: u32 = 10_000;
/// Most jobs that are done one at a time, for the round trip.
const ALONE: u64 = 1000;

/// What the bus costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenchResult {
    /// Local workers with one slot each.
    pub workers: usize,
    /// Jobs done as fast as possible.
    pub jobs: u64,
    /// Median round trip of one job at a time \[ms\].
    pub rtt_median_ms: f64,
    /// 99th percentile of the same \[ms\].
    pub rtt_p99_ms: f64,
    /// Jobs per second with all workers busy.
    pub jobs_per_s: f64,
    /// Processor time of this process per job, with all workers busy \[us\].
    pub coordinator_cpu_us_per_job: f64,
    /// Memory of this process at the end (MiB).
    pub coordinator_rss_mib: f64,
}

/// Measures round trip, rate and cost of the run that `options` describe; the run should be new.
///
/// # Errors
/// As [`Dispatch::open`] and [`Dispatch::next`].
pub async fn bench(options: DispatchOptions, jobs: u64) -> Result<BenchResult, DispatchError> {
    let workers = options.local_workers;
    let mut dispatch = Dispatch::open(options).await?;
    let mut id = 0;
    // the first jobs wait for the workers to start
    for _ in 0..2 * workers.max(1) {
        submit(&mut dispatch, &mut id)?;
    }
    for _ in 0..2 * workers.max(1) {
        dispatch.next().await?;
    }
    let mut trips = Vec::new();
    for _ in 0..jobs.clamp(1, ALONE) {
        let begun = Instant::now();
        submit(&mut dispatch, &mut id)?;
        dispatch.next().await?;
        trips.push(begun.elapsed());
    }
    trips.sort_unstable();
    let (begun, cpu) = (Instant::now(), cpu_time());
    for _ in 0..jobs {
        submit(&mut dispatch, &mut id)?;
    }
    for _ in 0..jobs {
        dispatch.next().await?;
    }
    let (wall, cpu) = (begun.elapsed(), cpu_time().saturating_sub(cpu));
    let coordinator_rss_mib = resident_mib();
    dispatch.close().await?;
    Ok(BenchResult {
        workers,
        jobs,
        rtt_median_ms: quantile_ms(&trips, 50),
        rtt_p99_ms: quantile_ms(&trips, 99),
        jobs_per_s: jobs as f64 / wall.as_secs_f64(),
        coordinator_cpu_us_per_job: cpu.as_secs_f64() * 1e6 / jobs.max(1) as f64,
        coordinator_rss_mib,
    })
}

fn submit(dispatch: &mut Dispatch, id: &mut u64) -> Result<(), DispatchError> {
    let payload = vec![7; JOB_BYTES];
    let job = Job::Nothing {
        payload,
        reply_bytes: RESULT_BYTES,
        delay_ms: 0,
    };
    *id += 1;
    dispatch.submit(JobId(*id - 1), job)
}

fn quantile_ms(sorted: &[Duration], percent: usize) -> f64 {
    let at = (sorted.len() * percent / 100).min(sorted.len().saturating_sub(1));
    sorted
        .get(at)
        .map_or(f64::NAN, |trip| trip.as_secs_f64() * 1e3)
}

/// Processor time of all living threads of this process; zero where the system does not say.
fn cpu_time() -> Duration {
    let threads = fs::read_dir("/proc/self/task")
        .into_iter()
        .flatten()
        .flatten();
    let nanos = threads.filter_map(|thread| {
        let stat = fs::read_to_string(thread.path().join("schedstat")).ok()?;
        stat.split_whitespace().next()?.parse::<u64>().ok()
    });
    Duration::from_nanos(nanos.sum())
}

/// Memory of this process; not a number where the system does not say.
fn resident_mib() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kib.unwrap_or(f64::NAN) / 1024.0
}
