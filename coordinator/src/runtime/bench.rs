//! The bus alone: jobs that do nothing, over a real journal; workers are real processes, or mere
//! sessions where there are to be more of them than the machine can bear.
mod sessions;
mod silent;

pub use sessions::connect;
pub use silent::{Silence, SilentPlan, SilentResult, keep_silent};

use super::{Dispatch, DispatchError, DispatchOptions};
use link::locator::Locator;
use protocol::{id::JobId, job::Job};
use sessions::{Connections, Sessions};
use std::{
    fs,
    time::{Duration, Instant},
};
use tokio::time::sleep;

/// Bytes of a job on its way to a worker, about those of a gene vector with its frame.
const JOB_BYTES: usize = 1000;
/// Most jobs that are done one at a time, for the round trip.
const ALONE: u64 = 1000;
/// Jobs asked for ahead, per worker: enough to keep them busy.
const AHEAD: u64 = 4;
/// Jobs that are done between two looks at the clock, over those asked for ahead.
const ROUND: u64 = 16;
/// How long workers may take to join before it is measured with those that are there.
const JOINING: Duration = Duration::from_mins(3);
/// Folder of the certificate that sessions of the bus show, within that of the coordinator.
const WORKER: &str = "worker-01";
/// Parts of the measurement whose cost is compared.
const PARTS: u64 = 10;

/// Who does the jobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crew {
    /// Worker processes with one slot process each, over TCP on loopback.
    Processes,
    /// Sessions of one other process, over TCP on loopback, or QUIC if the run has key material: all
    /// is real but the slots.
    Connections,
    /// Sessions of one thread of this process, over the memory link: frames, core and journal are
    /// the real ones, transport and slots are not there.
    Sessions,
}

/// What to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BenchPlan {
    /// Who does the jobs.
    pub crew: Crew,
    /// How many of them.
    pub workers: usize,
    /// Jobs done as fast as possible.
    pub jobs: u64,
    /// Bytes of each result; a residual vector has about 10,000, a score 300.
    pub result_bytes: u32,
    /// Connections that say nothing, to be measured beside. Not with [`Crew::Sessions`], which
    /// have no address.
    pub silent: Option<SilentPlan>,
}

/// What the bus costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenchResult {
    /// Workers with one slot each.
    pub workers: usize,
    /// From the opening until all of them had joined \[s\].
    pub joined_s: f64,
    /// Jobs done as fast as possible.
    pub jobs: u64,
    /// Median round trip of one job at a time \[ms\].
    pub rtt_median_ms: f64,
    /// 99th percentile of the same \[ms\].
    pub rtt_p99_ms: f64,
    /// Jobs per second with all workers busy.
    pub jobs_per_s: f64,
    /// Processor time of the coordinator per job, with all workers busy \[us\]: of this process,
    /// less the thread of sessions.
    pub coordinator_cpu_us_per_job: f64,
    /// The same for the last tenth of the jobs over the first: what stored results cost \[1\].
    pub cost_ratio: f64,
    /// Memory of this process at the end (MiB); with sessions of it, theirs too.
    pub coordinator_rss_mib: f64,
    /// What silent connections cost, if they were asked for.
    pub silent: Option<SilentResult>,
}

/// Measures round trip, rate and cost of the run that `options` describe; the run should be new.
///
/// # Errors
/// As [`Dispatch::open`] and [`Dispatch::next`].
pub async fn bench(
    mut options: DispatchOptions,
    plan: BenchPlan,
) -> Result<BenchResult, DispatchError> {
    let begun = Instant::now();
    let (mut dispatch, crew) = match plan.crew {
        Crew::Processes => {
            options.local_workers = plan.workers;
            (Dispatch::open(options).await?, Running::Local)
        }
        Crew::Connections => {
            let any = match options.tls {
                Some(_) => "quic/127.0.0.1:0",
                None => "tcp/127.0.0.1:0",
            };
            options.listen = Some(Locator::parse(any)?.with_free_port()?.to_string());
            let tls = options.tls.as_ref().map(|folder| folder.join(WORKER));
            let dispatch = Dispatch::open(options).await?;
            let at = dispatch.listening().into_iter().next().unwrap_or_default();
            let connections = Connections::start(plan.workers, &at, tls.as_deref());
            let connections = connections.map_err(DispatchError::Start)?;
            (dispatch, Running::Connections(connections))
        }
        Crew::Sessions => {
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
    let mut load = Load {
        plan,
        next: 0,
        open: 0,
    };
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
    Ok(BenchResult {
        workers,
        joined_s: joined.as_secs_f64(),
        jobs: plan.jobs,
        rtt_median_ms: quantile_ms(&trips, 50),
        rtt_p99_ms: quantile_ms(&trips, 99),
        jobs_per_s: plan.jobs as f64 / wall.as_secs_f64(),
        coordinator_cpu_us_per_job: cpu.as_secs_f64() * 1e6 / plan.jobs.max(1) as f64,
        cost_ratio: part(marks.len() - 2) / part(0),
        coordinator_rss_mib,
        silent,
    })
}

/// What does the jobs, where it is not the dispatcher's own workers; ends when dropped.
enum Running {
    Local,
    #[expect(dead_code, reason = "held for its end")]
    Connections(Connections),
    #[expect(dead_code, reason = "held for its end")]
    Sessions(Sessions),
}

/// Jobs that do nothing.
struct Load {
    plan: BenchPlan,
    next: u64,
    open: u64,
}

impl Load {
    /// Jobs that keep everybody busy for a moment.
    fn round(&self) -> u64 {
        ROUND * self.ahead()
    }

    /// Jobs asked for ahead.
    fn ahead(&self) -> u64 {
        AHEAD * self.plan.workers.max(1) as u64
    }

    /// Has so many jobs done, some asked for ahead.
    async fn run(&mut self, dispatch: &mut Dispatch, jobs: u64) -> Result<(), DispatchError> {
        let until = self.next + jobs;
        let ahead = self.ahead();
        while self.next < until || self.open > 0 {
            while self.next < until && self.open < ahead {
                self.submit(dispatch)?;
            }
            dispatch.next().await?;
            self.open -= 1;
        }
        Ok(())
    }

    fn submit(&mut self, dispatch: &mut Dispatch) -> Result<(), DispatchError> {
        let job = Job::Nothing {
            payload: vec![7; JOB_BYTES],
            reply_bytes: self.plan.result_bytes,
            delay_ms: 0,
        };
        self.next += 1;
        self.open += 1;
        dispatch.submit(JobId(self.next - 1), job)
    }
}

fn quantile_ms(sorted: &[Duration], percent: usize) -> f64 {
    let at = (sorted.len() * percent / 100).min(sorted.len().saturating_sub(1));
    sorted
        .get(at)
        .map_or(f64::NAN, |trip| trip.as_secs_f64() * 1e3)
}

/// Processor time of the coordinator.
fn cost() -> Duration {
    cpu_time(|thread| thread != sessions::THREAD)
}

/// Processor time of the living threads of this process that are counted, by name; zero where the
/// system does not say.
fn cpu_time(counts: impl Fn(&str) -> bool) -> Duration {
    let threads = fs::read_dir("/proc/self/task")
        .into_iter()
        .flatten()
        .flatten();
    let nanos = threads.filter_map(|thread| {
        let name = fs::read_to_string(thread.path().join("comm")).ok()?;
        counts(name.trim_end()).then_some(())?;
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
