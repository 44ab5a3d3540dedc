//! Measurement of round-trip time, job rate and coordinator cost.
use super::{
    load::Load,
    meter::{processor_time, resident_mib},
};
use crate::runtime::{Dispatch, DispatchError, DispatchOptions};
use serde::Serialize;
use std::time::{Duration, Instant};
use support::quantile;
use tokio::time::sleep;

/// Maximum number of jobs run one at a time to measure the round trip.
const ALONE: u64 = 1000;
/// Time limit for workers to join, after which the connected workers are measured.
const JOINING: Duration = Duration::from_mins(3);
/// Number of equal parts of the full-rate measurement; the first and the last are compared.
const PARTS: u64 = 10;

/// Plan of a bus benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BenchPlan {
    /// Number of workers that do the benchmark's jobs, with one slot each.
    pub workers: usize,
    /// Number of jobs to run at full rate.
    pub jobs: u64,
    /// Size of each result (bytes); a residual vector has about 10,000, a score 300.
    pub result_bytes: u32,
}

/// Result of a bus benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BenchResult {
    /// Number of workers that did the jobs, with one slot each.
    pub workers: usize,
    /// Time from opening the run until all workers had joined \[s\].
    pub joined_s: f64,
    /// Number of jobs run at full rate.
    pub jobs: u64,
    /// Round-trip time of one job at a time \[ms\].
    pub rtt_ms: RoundTrip,
    /// Jobs per second with all workers busy.
    pub jobs_per_s: f64,
    /// Processor time of the coordinator per job, with all workers busy \[us\].
    pub coordinator_cpu_us_per_job: f64,
    /// Coordinator processor time per job in the last tenth of the jobs over that in the first: growth of the
    /// cost with stored results \[1\].
    pub cost_ratio: f64,
    /// Resident memory of this process at the end (MiB).
    pub coordinator_rss_mib: f64,
}

/// Round-trip times of jobs dispatched one at a time \[ms\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RoundTrip {
    /// Median.
    pub median: f64,
    /// 99th percentile.
    pub p99: f64,
}

/// Measures round trip, job rate and cost of the run described by `options`, with worker processes of this machine;
/// the run should be new.
///
/// # Errors
/// As [`Dispatch::open`] and [`Dispatch::next`].
pub async fn measure(
    mut options: DispatchOptions,
    plan: BenchPlan,
) -> Result<BenchResult, DispatchError> {
    let begun = Instant::now();
    options.local_workers = plan.workers;
    let mut dispatch = Dispatch::open(options).await?;
    let mut load = Load::new(plan.workers, plan.result_bytes);
    let result = measure_on(&mut dispatch, &mut load, plan, (begun, processor_time)).await?;
    dispatch.close().await?;
    Ok(result)
}

/// Measures an open run whose workers join by themselves; `begun` is when they were started, and `cost` returns the
/// processor time of the coordinator so far.
///
/// # Errors
/// As [`Dispatch::next`].
pub async fn measure_on(
    dispatch: &mut Dispatch,
    load: &mut Load,
    plan: BenchPlan,
    (begun, cost): (Instant, fn() -> Duration),
) -> Result<BenchResult, DispatchError> {
    while dispatch.snapshot().workers.len() < plan.workers && begun.elapsed() < JOINING {
        sleep(Duration::from_millis(5)).await;
    }
    let (joined, workers) = (begun.elapsed(), dispatch.snapshot().workers.len());
    // the first jobs wait for the workers to start
    load.run(dispatch, 2 * plan.workers.max(1) as u64).await?;
    let mut trips = Vec::new();
    for _ in 0..plan.jobs.clamp(1, ALONE) {
        let begun = Instant::now();
        load.run(dispatch, 1).await?;
        trips.push(begun.elapsed());
    }
    trips.sort_unstable();
    let begun = Instant::now();
    let mut marks = vec![cost()];
    for part in 0..PARTS {
        let jobs = plan.jobs * (part + 1) / PARTS - plan.jobs * part / PARTS;
        load.run(dispatch, jobs).await?;
        marks.push(cost());
    }
    let wall = begun.elapsed();
    let part = |n: usize| marks[n + 1].saturating_sub(marks[n]).as_secs_f64();
    let cpu = marks[marks.len() - 1].saturating_sub(marks[0]);
    let quantile_ms = |percent| {
        let trip: Option<Duration> = quantile::of(&trips, percent);
        trip.map_or(f64::NAN, |trip| trip.as_secs_f64() * 1e3)
    };
    Ok(BenchResult {
        workers,
        joined_s: joined.as_secs_f64(),
        jobs: plan.jobs,
        rtt_ms: RoundTrip {
            median: quantile_ms(50),
            p99: quantile_ms(99),
        },
        jobs_per_s: plan.jobs as f64 / wall.as_secs_f64(),
        coordinator_cpu_us_per_job: cpu.as_secs_f64() * 1e6 / plan.jobs.max(1) as f64,
        cost_ratio: part(marks.len() - 2) / part(0),
        coordinator_rss_mib: resident_mib(),
    })
}
