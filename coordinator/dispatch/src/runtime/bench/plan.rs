//! What is measured of the bus, and what comes out.

/// Who does the jobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BenchWorkers {
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
    pub by: BenchWorkers,
    /// How many of them.
    pub workers: usize,
    /// Jobs done as fast as possible.
    pub jobs: u64,
    /// Bytes of each result; a residual vector has about 10,000, a score 300.
    pub result_bytes: u32,
    /// Connections that say nothing, to be measured beside. Not with [`BenchWorkers::Sessions`], which
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

/// How far peers go that say nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Silence {
    /// They connect; the coordinator closes them when they have not opened a session in time.
    Connection,
    /// They open a session of the bus, which exchanges keep-alives for ever, and never announce
    /// themselves.
    Session,
}

/// Connections that say nothing, to be measured beside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SilentPlan {
    /// How far they go.
    pub silence: Silence,
    /// How many there are at a time.
    pub connections: usize,
    /// How often it is measured without and with them; once at least.
    pub turns: usize,
}

/// What silent connections cost.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct SilentResult {
    /// How many were asked for.
    pub connections: usize,
    /// The fewest that the coordinator held when a block began or ended.
    pub held: usize,
    /// How often one that had been closed was opened again, in all blocks.
    pub reopened: u64,
    /// Blocks without, and as many with them.
    pub turns: usize,
    /// Jobs per second without them, the median block.
    pub jobs_per_s_without: f64,
    /// Jobs per second beside them, the median block.
    pub jobs_per_s_beside: f64,
    /// Rate beside them over that of the block before, without: the median \[1\].
    pub rate_ratio: f64,
    /// The smallest and the largest of those \[1\].
    pub rate_ratio_range: (f64, f64),
    /// The same of the coordinator's processor time per job: the median \[1\].
    pub cpu_ratio: f64,
}
