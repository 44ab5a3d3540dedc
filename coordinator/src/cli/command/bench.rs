//! `horsehead bench`: measures the overhead of job dispatch with no-op jobs, without simulation.
use crate::cli::{
    argument::output::{Output, OutputChoice},
    output::{problem::EXIT_CODES, terminal},
    run::dispatcher,
};
use clap::{Args, Subcommand};
use dispatch::runtime::{
    self, BenchPlan, BenchWorkers, DispatchOptions, SilentPlan, SilentResult, SilentStage,
};
use link::locator::Locator;
use protocol::case::Case;
use serde::Serialize;
use std::path::PathBuf;
use study::EvaluatorError;

/// Measure the overhead of dispatching jobs.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    what: Benchmark,
}

#[derive(Debug, Subcommand)]
enum Benchmark {
    /// The bus alone: no-op jobs to local workers.
    #[command(after_help = format!("\
Examples:
  horsehead bench dispatch --workers 2 --jobs 20000
  horsehead bench dispatch --connections 512
  horsehead bench dispatch --connections 64 --tls keys
  horsehead bench dispatch --sessions 512 --jobs 1000000 --result-bytes 300
  horsehead bench dispatch --silent 5000
  horsehead bench dispatch --connections 64 --idle 900

{EXIT_CODES}"))]
    Dispatch {
        /// Worker processes to start, each with one slot process.
        #[arg(long, value_name = "N", default_value_t = 2, env = "HORSEHEAD_WORKERS", value_parser = clap::value_parser!(u32).range(1..=1024))]
        workers: u32,
        /// Instead of processes, use this many workers that are only sessions within this process, over the
        /// memory link: no transport and no slots, the rest is real.
        #[arg(long, value_name = "N", env = "HORSEHEAD_SESSIONS", value_parser = clap::value_parser!(u32).range(1..=16_384))]
        sessions: Option<u32>,
        /// Instead of processes, use this many workers that are only sessions of one other process, over TCP
        /// on loopback: no slots, the rest is real.
        #[arg(long, value_name = "N", conflicts_with = "sessions", env = "HORSEHEAD_CONNECTIONS", value_parser = clap::value_parser!(u32).range(1..=990))]
        connections: Option<u32>,
        /// Have those connections come over QUIC instead of TCP, with the certificate of `worker-01` of
        /// this folder of `horsehead keys new DIR --host 127.0.0.1`; nothing without --connections or
        /// with --silent or --idle.
        #[arg(long, value_name = "DIR", env = "HORSEHEAD_TLS")]
        tls: Option<PathBuf>,
        /// Number of jobs to run.
        #[arg(long, value_name = "N", default_value_t = 10_000, env = "HORSEHEAD_JOBS", value_parser = clap::value_parser!(u64).range(1..))]
        jobs: u64,
        /// Bytes of each result: a score has about 300, one with its residual 10,000.
        #[arg(long, value_name = "N", default_value_t = 10_000, env = "HORSEHEAD_RESULT_BYTES", value_parser = clap::value_parser!(u32).range(..=10_000_000))]
        result_bytes: u32,
        /// Also measure, alternately without and with them, the cost of this many connections that send
        /// nothing and are reopened whenever the coordinator closes them.
        #[arg(long, value_name = "N", conflicts_with = "sessions", env = "HORSEHEAD_SILENT", value_parser = clap::value_parser!(u32).range(1..=8000))]
        silent: Option<u32>,
        /// As --silent, with sessions of the bus that never announce themselves; the coordinator takes 1,000
        /// sessions in all.
        #[arg(long, value_name = "N", conflicts_with_all = ["sessions", "silent"], env = "HORSEHEAD_IDLE", value_parser = clap::value_parser!(u32).range(1..=990))]
        idle: Option<u32>,
        /// Number of repetitions with --silent or --idle: each takes 8 s without and 8 s with the silent
        /// connections.
        #[arg(long, value_name = "N", default_value_t = 5, env = "HORSEHEAD_TURNS", value_parser = clap::value_parser!(u32).range(1..=1000))]
        turns: u32,
        #[command(flatten)]
        output: OutputChoice,
    },
    /// Act as many workers that are only sessions, for `bench dispatch --connections`.
    #[command(hide = true, after_help = format!("\
Example:
  horsehead bench sessions unix/sockets/bus 64

{EXIT_CODES}"))]
    Sessions {
        /// Address to dial.
        #[arg(value_name = "LOCATOR", value_parser = Locator::parse)]
        connect: Locator,
        /// Number of sessions.
        #[arg(value_name = "N")]
        sessions: usize,
        /// Key material of a worker.
        #[arg(long, value_name = "DIR", env = "HORSEHEAD_TLS")]
        tls: Option<PathBuf>,
    },
    /// Hold connections that send nothing, for `bench dispatch` with `--silent` or `--idle`, until standard
    /// input ends.
    #[command(hide = true, after_help = format!("\
Example:
  horsehead bench silent unix/sockets/bus 5000

{EXIT_CODES}"))]
    Silent {
        /// Address to dial.
        #[arg(value_name = "LOCATOR", value_parser = Locator::parse)]
        connect: Locator,
        /// Number of connections.
        #[arg(value_name = "N")]
        connections: usize,
        /// Open a session of the bus on each.
        #[arg(long, env = "HORSEHEAD_OPENED")]
        opened: bool,
    },
}

/// JSON object printed by `horsehead bench dispatch --output json`.
#[derive(Debug, Serialize)]
struct BenchOutput {
    /// Kind of workers measured: `processes` over TCP on loopback, `connections` of one other process over
    /// TCP or QUIC on loopback, or `sessions` of this process over the memory link.
    crew: &'static str,
    workers: usize,
    /// Time until all workers had joined (s).
    joined_s: f64,
    jobs: u64,
    /// Round-trip time of jobs dispatched one at a time (ms).
    rtt_ms: RoundTrip,
    /// Throughput with every worker busy (jobs/s).
    jobs_per_s: f64,
    /// CPU time of the coordinator per job (us).
    coordinator_cpu_us_per_job: f64,
    /// Coordinator CPU time per job in the last tenth of the jobs, divided by that in the first tenth.
    cost_ratio: f64,
    /// Resident memory of the coordinator process (MiB).
    coordinator_rss_mib: f64,
    /// Cost of silent connections to the coordinator; null unless `--silent` or `--idle` is given.
    silent: Option<SilentResult>,
}

/// Round-trip times of jobs dispatched one at a time (ms).
#[derive(Debug, Serialize)]
struct RoundTrip {
    median: f64,
    p99: f64,
}

/// Runs the selected benchmark of job dispatch and prints its result.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.what {
        Benchmark::Dispatch {
            workers,
            sessions,
            connections,
            tls,
            jobs,
            result_bytes,
            silent,
            idle,
            turns,
            output: OutputChoice { output },
        } => {
            let tls = tls
                .clone()
                .filter(|_| connections.is_some() && silent.or(*idle).is_none());
            let (crew, workers, of_what) = match (sessions, connections) {
                (Some(sessions), _) => (
                    BenchWorkers::Sessions,
                    *sessions,
                    "sessions of this process (memory link)",
                ),
                (None, Some(connections)) => (
                    BenchWorkers::Connections,
                    *connections,
                    match &tls {
                        Some(_) => "sessions of another process (QUIC on loopback)",
                        None => "sessions of another process (TCP on loopback)",
                    },
                ),
                (None, None) => (
                    BenchWorkers::Processes,
                    *workers,
                    "worker processes (TCP on loopback)",
                ),
            };
            let plan = BenchPlan {
                by: crew,
                workers: workers as usize,
                jobs: *jobs,
                result_bytes: *result_bytes,
                silent: silent.or(*idle).map(|connections| SilentPlan {
                    silence: match idle {
                        None => SilentStage::Connection,
                        Some(_) => SilentStage::Session,
                    },
                    connections: connections as usize,
                    turns: *turns as usize,
                }),
            };
            dispatch(plan, tls, of_what, *output)
        }
        Benchmark::Sessions {
            connect,
            sessions,
            tls,
        } => dispatcher::block_on(async {
            Ok(runtime::connect(connect, *sessions, tls.as_deref()).await?)
        }),
        Benchmark::Silent {
            connect,
            connections,
            opened,
        } => {
            let silence = if *opened {
                SilentStage::Session
            } else {
                SilentStage::Connection
            };
            dispatcher::block_on(async {
                Ok(runtime::keep_silent(connect, silence, *connections).await?)
            })
        }
    }
}

fn dispatch(
    plan: BenchPlan,
    tls: Option<PathBuf>,
    of_what: &str,
    output: Output,
) -> anyhow::Result<()> {
    if output == Output::Table {
        let (jobs, workers) = (plan.jobs, plan.workers);
        terminal::tell(&format!("{jobs} no-op jobs on {workers} {of_what}"));
    }
    let result = dispatcher::block_on(measure(plan, tls))?;
    let table = || {
        let mut text = format!(
            "{} workers   joined within {:.2} s\n\
             round trip   {:>10.3} ms median, {:.3} ms at 99 %\n\
             throughput   {:>10.0} jobs/s\n\
             coordinator  {:>10.1} us CPU per job, {:.2} times as much for the last tenth as for \
             the first; {:.1} MiB\n",
            result.workers,
            result.joined_s,
            result.rtt_ms.median,
            result.rtt_ms.p99,
            result.jobs_per_s,
            result.coordinator_cpu_us_per_job,
            result.cost_ratio,
            result.coordinator_rss_mib
        );
        if let Some(silent) = &result.silent {
            text += &silent_text(silent);
        }
        text
    };
    terminal::print(output, table, &result)
}

fn silent_text(silent: &SilentResult) -> String {
    let (smallest, largest) = silent.rate_ratio_range;
    format!(
        "beside {} that say nothing ({} held at least, {} opened again in {} blocks):\n\
         throughput   {:>10.0} jobs/s, {:.0} without: {:.3} times, {smallest:.3} to {largest:.3}\n\
         coordinator  {:>10.2} times the CPU per job\n",
        silent.connections,
        silent.held,
        silent.reopened,
        silent.turns,
        silent.jobs_per_s_beside,
        silent.jobs_per_s_without,
        silent.rate_ratio,
        silent.cpu_ratio,
    )
}

/// Measures the dispatcher with no-op jobs in a temporary run folder, over QUIC if key material is given.
async fn measure(plan: BenchPlan, tls: Option<PathBuf>) -> anyhow::Result<BenchOutput> {
    let scratch = tempfile::tempdir()?;
    let settings = "{}".to_owned();
    let mut options =
        DispatchOptions::local(scratch.path(), 0, &Case::default(), "bench", settings)?;
    options.tls = tls;
    let result = runtime::bench(options, plan).await;
    let result = result.map_err(EvaluatorError::from)?;
    Ok(BenchOutput {
        crew: match plan.by {
            BenchWorkers::Processes => "processes",
            BenchWorkers::Connections => "connections",
            BenchWorkers::Sessions => "sessions",
        },
        workers: result.workers,
        joined_s: result.joined_s,
        jobs: result.jobs,
        rtt_ms: RoundTrip {
            median: result.rtt_median_ms,
            p99: result.rtt_p99_ms,
        },
        jobs_per_s: result.jobs_per_s,
        coordinator_cpu_us_per_job: result.coordinator_cpu_us_per_job,
        cost_ratio: result.cost_ratio,
        coordinator_rss_mib: result.coordinator_rss_mib,
        silent: result.silent,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    fn fields(value: &Value) -> Vec<&str> {
        let mut fields: Vec<&str> = value
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        fields.sort_unstable();
        fields
    }

    #[test]
    fn a_bench_has_the_fields_that_programs_rely_on() {
        let object = BenchOutput {
            crew: "processes",
            workers: 2,
            joined_s: 0.5,
            jobs: 1000,
            rtt_ms: RoundTrip {
                median: 0.25,
                p99: 1.0,
            },
            jobs_per_s: 4000.0,
            coordinator_cpu_us_per_job: 120.0,
            cost_ratio: 1.0,
            coordinator_rss_mib: 22.0,
            silent: Some(SilentResult {
                connections: 5000,
                held: 4900,
                reopened: 8000,
                turns: 5,
                jobs_per_s_without: 2000.0,
                jobs_per_s_beside: 1900.0,
                rate_ratio: 0.95,
                rate_ratio_range: (0.9, 1.0),
                cpu_ratio: 1.05,
            }),
        };
        let value = serde_json::to_value(&object).unwrap();
        assert_eq!(
            fields(&value),
            [
                "coordinator_cpu_us_per_job",
                "coordinator_rss_mib",
                "cost_ratio",
                "crew",
                "jobs",
                "jobs_per_s",
                "joined_s",
                "rtt_ms",
                "silent",
                "workers"
            ]
        );
        assert_eq!(fields(&value["rtt_ms"]), ["median", "p99"]);
        assert_eq!(
            value["silent"]["rate_ratio_range"],
            serde_json::json!([0.9, 1.0])
        );
    }
}
