//! Benchmark of the bus: round-trip time, job rate and coordinator cost.
use super::{
    load::Load,
    meter::{cost, resident_mib},
    plan::{BenchPlan, BenchResult, BenchWorkers},
    sessions::{Connections, Sessions},
    silent,
};
use crate::runtime::{dispatch::Dispatch, error::DispatchError, listen, options::DispatchOptions};
use std::time::{Duration, Instant};
use support::quantile;
use tempfile::TempDir;
use tokio::time::sleep;

/// Maximum number of jobs run one at a time to measure the round trip.
const ALONE: u64 = 1000;
/// Time limit for workers to join, after which the connected workers are measured.
const JOINING: Duration = Duration::from_mins(3);
/// Subfolder of the coordinator's key folder with the certificate that benchmark sessions use.
const WORKER: &str = "worker-01";
/// Number of equal parts of the full-rate measurement; the first and the last are compared.
const PARTS: u64 = 10;

/// Measures round trip, job rate and cost of the run described by `options`; the run should be new.
///
/// # Errors
/// As [`Dispatch::open`] and [`Dispatch::next`].
pub async fn bench(
    mut options: DispatchOptions,
    plan: BenchPlan,
) -> Result<BenchResult, DispatchError> {
    let begun = Instant::now();
    let (mut dispatch, crew) = match plan.by {
        BenchWorkers::Processes => {
            options.local_workers = plan.workers;
            (Dispatch::open(options).await?, Running::Local)
        }
        BenchWorkers::Connections => {
            let (folder, socket) = listen::local_socket().map_err(DispatchError::Socket)?;
            options.listen = Some(match options.tls {
                Some(_) => "quic/127.0.0.1:0".to_owned(),
                None => socket.to_string(),
            });
            let tls = options.tls.as_ref().map(|folder| folder.join(WORKER));
            let dispatch = Dispatch::open(options).await?;
            let at = dispatch.listening().into_iter().next().unwrap_or_default();
            let connections = Connections::start(plan.workers, &at, tls.as_deref());
            let connections = connections.map_err(DispatchError::Start)?;
            (dispatch, Running::Connections(connections, folder))
        }
        BenchWorkers::Sessions => {
            let mut crew = Running::Local;
            let dispatch = Dispatch::over(&options, |_, blob| {
                let (end, started) = Sessions::start(plan.workers, blob);
                crew = Running::Sessions(started);
                end
            })?;
            (dispatch, crew)
        }
    };
    while dispatch.snapshot().workers.len() < plan.workers && begun.elapsed() < JOINING {
        sleep(Duration::from_millis(5)).await;
    }
    let (joined, workers) = (begun.elapsed(), dispatch.snapshot().workers.len());
    let mut load = Load::new(plan.workers, plan.result_bytes);
    // the first jobs wait for the workers to start
    load.run(&mut dispatch, 2 * plan.workers.max(1) as u64)
        .await?;
    let mut trips = Vec::new();
    for _ in 0..plan.jobs.clamp(1, ALONE) {
        let begun = Instant::now();
        load.run(&mut dispatch, 1).await?;
        trips.push(begun.elapsed());
    }
    trips.sort_unstable();
    let begun = Instant::now();
    let mut marks = vec![cost()];
    for part in 0..PARTS {
        let jobs = plan.jobs * (part + 1) / PARTS - plan.jobs * part / PARTS;
        load.run(&mut dispatch, jobs).await?;
        marks.push(cost());
    }
    let wall = begun.elapsed();
    let part = |n: usize| marks[n + 1].saturating_sub(marks[n]).as_secs_f64();
    let cpu = marks[marks.len() - 1].saturating_sub(marks[0]);
    let coordinator_rss_mib = resident_mib();
    let silent = match plan.silent {
        Some(silent) => Some(silent::measure(&mut dispatch, &mut load, silent).await?),
        None => None,
    };
    dispatch.close().await?;
    drop(crew);
    let quantile_ms = |percent| {
        let trip: Option<Duration> = quantile::of(&trips, percent);
        trip.map_or(f64::NAN, |trip| trip.as_secs_f64() * 1e3)
    };
    Ok(BenchResult {
        workers,
        joined_s: joined.as_secs_f64(),
        jobs: plan.jobs,
        rtt_median_ms: quantile_ms(50),
        rtt_p99_ms: quantile_ms(99),
        jobs_per_s: plan.jobs as f64 / wall.as_secs_f64(),
        coordinator_cpu_us_per_job: cpu.as_secs_f64() * 1e6 / plan.jobs.max(1) as f64,
        cost_ratio: part(marks.len() - 2) / part(0),
        coordinator_rss_mib,
        silent,
    })
}

/// Guard of the benchmark's workers, which end when it is dropped; `Local` if the dispatcher owns them.
enum Running {
    Local,
    #[expect(dead_code, reason = "held for its end")]
    Connections(Connections, TempDir),
    #[expect(dead_code, reason = "held for its end")]
    Sessions(Sessions),
}
