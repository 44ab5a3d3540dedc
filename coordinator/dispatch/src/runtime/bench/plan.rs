//! Plan and results of a bus benchmark.

/// Kind of workers that do a benchmark's jobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BenchWorkers {
    /// Worker processes with one slot process each, over TCP on loopback.
    Processes,
    /// Sessions (worker connections without slots) in one other process, over TCP on loopback, or QUIC if the
    /// run has key material; everything but the slots is real.
    Connections,
    /// Sessions (worker connections without slots) on one thread of this process, over the memory link;
    /// frames, core and journal are real, transport and slots are absent.
    Sessions,
}

/// Plan of a bus benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BenchPlan {
    /// Kind of the workers that do the benchmark's jobs.
    pub by: BenchWorkers,
    /// Number of workers that do the benchmark's jobs.
    pub workers: usize,
    /// Number of jobs to run at full rate.
    pub jobs: u64,
    /// Size of each result (bytes); a residual vector has about 10,000, a score 300.
    pub result_bytes: u32,
    /// Plan of the additional measurement with silent connections, if any. Not possible with
    /// [`BenchWorkers::Sessions`], which have no address.
    pub silent: Option<SilentPlan>,
}

/// Result of a bus benchmark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenchResult {
    /// Number of workers that did the jobs, with one slot each.
    pub workers: usize,
    /// Time from opening the run until all workers had joined \[s\].
    pub joined_s: f64,
    /// Number of jobs run at full rate.
    pub jobs: u64,
    /// Median round trip of one job at a time \[ms\].
    pub rtt_median_ms: f64,
    /// 99th percentile of the round trip of one job at a time \[ms\].
    pub rtt_p99_ms: f64,
    /// Jobs per second with all workers busy.
    pub jobs_per_s: f64,
    /// Processor time of the coordinator per job, with all workers busy \[us\]: of this process without the
    /// sessions thread.
    pub coordinator_cpu_us_per_job: f64,
    /// Coordinator processor time per job in the last tenth of the jobs over that in the first: growth of the
    /// cost with stored results \[1\].
    pub cost_ratio: f64,
    /// Resident memory of this process at the end, including in-process sessions (MiB).
    pub coordinator_rss_mib: f64,
    /// Cost of silent connections, if measured.
    pub silent: Option<SilentResult>,
}

/// Stage of connecting at which silent peers stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SilentStage {
    /// Peers open a connection only; the coordinator closes it when no session is opened in time.
    Connection,
    /// Peers open a bus session, which exchanges keep-alives indefinitely, but never announce themselves.
    Session,
}

/// Plan for measuring the cost of silent connections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SilentPlan {
    /// Stage at which the silent peers stop.
    pub silence: SilentStage,
    /// Number of simultaneous silent connections.
    pub connections: usize,
    /// Number of pairs of measurement blocks, one without and one with silent connections; at least one.
    pub turns: usize,
}

/// Measured cost of silent connections.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct SilentResult {
    /// Number of silent connections requested.
    pub connections: usize,
    /// Smallest number of silent connections held by the coordinator at the start or end of a block.
    pub held: usize,
    /// Number of times a closed connection was reopened, over all blocks.
    pub reopened: u64,
    /// Number of pairs of measurement blocks, one without and one with silent connections.
    pub turns: usize,
    /// Jobs per second without silent connections, median of the blocks.
    pub jobs_per_s_without: f64,
    /// Jobs per second with silent connections, median of the blocks.
    pub jobs_per_s_beside: f64,
    /// Ratio of the job rate with silent connections to that of the preceding block without, median \[1\].
    pub rate_ratio: f64,
    /// Smallest and largest ratio of the job rates with and without silent connections \[1\].
    pub rate_ratio_range: (f64, f64),
    /// Ratio of the coordinator's processor time per job with silent connections to that without, median
    /// \[1\].
    pub cpu_ratio: f64,
}
