//! Command `bench dispatch`: the bus with more workers than this machine can run as processes, and beside connections
//! that say nothing.
//!
//! Workers are mere sessions: they speak the protocol and answer empty jobs, without slots.
pub(crate) mod sessions;
mod silent;

use crate::output::{Output, table};
use clap::{Args, Subcommand};
use dispatch::{
    bench::{BenchPlan, BenchResult, Load, measure_on, processor_time},
    runtime::{Dispatch, DispatchOptions},
};
use link::locator::Locator;
use protocol::case::Case;
use serde::Serialize;
use sessions::{Connections, Sessions, open_with_connections};
use silent::{SilentPlan, SilentResult, SilentStage};
use std::{path::PathBuf, time::Instant};
use tempfile::TempDir;

/// Dispatch empty jobs to many sessions: round trip, rate and the coordinator's cost per result.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  bench dispatch --connections 512
  bench dispatch --connections 64 --idle 900
  bench dispatch --connections 64 --jobs 60000 --result-bytes 25000 --tls keys
  bench dispatch --connections 64 --silent 5000
  bench dispatch --sessions 64 --jobs 1000000 --result-bytes 300

`horsehead bench dispatch` measures the same with worker processes.")]
pub(crate) struct Arguments {
    /// Number of sessions of one other process, over a Unix socket.
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=990))]
    connections: u32,
    /// Instead, this many sessions within this process, over the memory link: no transport, the rest is real.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=16_384))]
    sessions: Option<u32>,
    /// Connect over QUIC instead, with the certificate of `worker-01` of this folder, as
    /// `horsehead keys new DIR --host 127.0.0.1` makes it.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["sessions", "silent", "idle"])]
    tls: Option<PathBuf>,
    /// Number of jobs to run.
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u64).range(1..))]
    jobs: u64,
    /// Bytes of each result: a score has about 300, one with its residual 10,000.
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    result_bytes: u32,
    /// Also measure, alternately without and with them, the cost of this many connections that send nothing and are
    /// opened again whenever the coordinator closes them.
    #[arg(long, value_name = "N", conflicts_with = "sessions", value_parser = clap::value_parser!(u32).range(1..=8000))]
    silent: Option<u32>,
    /// As --silent, with sessions of the bus that never announce themselves; the coordinator takes 1,000 sessions in
    /// all.
    #[arg(long, value_name = "N", conflicts_with_all = ["sessions", "silent"], value_parser = clap::value_parser!(u32).range(1..=990))]
    idle: Option<u32>,
    /// Number of repetitions with --silent or --idle: each takes 8 s without and 8 s with the silent connections.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000))]
    turns: u32,
    #[command(flatten)]
    output: Output,
}

/// Peers that `bench dispatch` and `bench scaling` start in another process of this program.
#[derive(Debug, Subcommand)]
pub(crate) enum Peers {
    /// Answer jobs in many sessions.
    Sessions {
        /// Address to dial.
        #[arg(value_parser = Locator::parse)]
        connect: Locator,
        /// Number of sessions.
        sessions: usize,
        /// Key material of a worker.
        #[arg(long)]
        tls: Option<PathBuf>,
    },
    /// Hold connections that send nothing until standard input ends.
    Silent {
        /// Address to dial.
        #[arg(value_parser = Locator::parse)]
        connect: Locator,
        /// Number of connections.
        connections: usize,
        /// Open a session of the bus on each.
        #[arg(long)]
        opened: bool,
    },
}

/// Result as printed with `--output json`.
#[derive(Debug, Serialize)]
struct Object {
    #[serde(flatten)]
    result: BenchResult,
    /// Cost of silent connections; null unless `--silent` or `--idle` is given.
    silent: Option<SilentResult>,
}

/// Workers of the benchmark, which end when this value is dropped.
enum Workers {
    #[expect(dead_code, reason = "held for its end")]
    Connections(Connections, TempDir),
    #[expect(dead_code, reason = "held for its end")]
    Sessions(Option<Sessions>),
}

/// Runs the peers that another process of this program asked for.
pub(crate) fn serve(peers: &Peers) -> anyhow::Result<()> {
    tokio::runtime::Runtime::new()?.block_on(async {
        match peers {
            Peers::Sessions {
                connect,
                sessions,
                tls,
            } => Ok(sessions::connect(connect, *sessions, tls.as_deref()).await?),
            Peers::Silent {
                connect,
                connections,
                opened,
            } => {
                let stage = if *opened {
                    SilentStage::Session
                } else {
                    SilentStage::Connection
                };
                Ok(silent::keep_silent(connect, stage, *connections).await?)
            }
        }
    })
}

/// Measures and prints the result.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let object = tokio::runtime::Runtime::new()?.block_on(measure(arguments))?;
    let result = &object.result;
    let mut rows = vec![
        ("workers", result.workers.to_string()),
        ("joined within [s]", format!("{:.2}", result.joined_s)),
        (
            "round trip, median [ms]",
            format!("{:.3}", result.rtt_ms.median),
        ),
        ("round trip, 99 % [ms]", format!("{:.3}", result.rtt_ms.p99)),
        ("results/s", format!("{:.0}", result.jobs_per_s)),
        (
            "coordinator, processor time a result [us]",
            format!("{:.1}", result.coordinator_cpu_us_per_job),
        ),
        (
            "the last tenth over the first",
            format!("{:.2}", result.cost_ratio),
        ),
        ("memory [MiB]", format!("{:.1}", result.coordinator_rss_mib)),
    ];
    if let Some(silent) = &object.silent {
        let (smallest, largest) = silent.rate_ratio_range;
        rows.extend([
            (
                "silent connections, asked for",
                silent.connections.to_string(),
            ),
            ("held at least", silent.held.to_string()),
            ("opened again", silent.reopened.to_string()),
            (
                "results/s without them",
                format!("{:.0}", silent.jobs_per_s_without),
            ),
            (
                "results/s beside them",
                format!("{:.0}", silent.jobs_per_s_beside),
            ),
            (
                "ratio of the rates",
                format!("{:.3} ({smallest:.3} to {largest:.3})", silent.rate_ratio),
            ),
            (
                "ratio of the processor time a result",
                format!("{:.2}", silent.cpu_ratio),
            ),
        ]);
    }
    let mut shown = table(&["", "measured"]);
    for (name, value) in rows {
        shown.add_row([name.to_owned(), value]);
    }
    arguments.output.print(&shown, &object)
}

async fn measure(arguments: &Arguments) -> anyhow::Result<Object> {
    let scratch = tempfile::tempdir()?;
    let (case, settings) = (Case::default(), "{}".to_owned());
    let mut options = DispatchOptions::local(scratch.path(), 0, &case, "bench", settings)?;
    let begun = Instant::now();
    let count = arguments.sessions.unwrap_or(arguments.connections) as usize;
    let (mut dispatch, workers) = if arguments.sessions.is_some() {
        let mut started = None;
        let dispatch = Dispatch::over(&options, |_, blob| {
            let (end, sessions) = Sessions::start(count, blob);
            started = Some(sessions);
            end
        })?;
        (dispatch, Workers::Sessions(started))
    } else {
        options.access.tls.clone_from(&arguments.tls);
        let opened = open_with_connections(options, count).await?;
        let (dispatch, connections, folder) = opened;
        (dispatch, Workers::Connections(connections, folder))
    };
    let plan = BenchPlan {
        workers: count,
        jobs: arguments.jobs,
        result_bytes: arguments.result_bytes,
    };
    let cost = if arguments.sessions.is_some() {
        sessions::cost_without_sessions
    } else {
        processor_time
    };
    let mut load = Load::new(count, arguments.result_bytes);
    let result = measure_on(&mut dispatch, &mut load, plan, (begun, cost)).await?;
    let stages = [
        (arguments.silent, SilentStage::Connection),
        (arguments.idle, SilentStage::Session),
    ];
    let asked = stages
        .into_iter()
        .find_map(|(count, stage)| Some((count?, stage)));
    let silent = match asked {
        Some((connections, stage)) => {
            let plan = SilentPlan {
                stage,
                connections: connections as usize,
                turns: arguments.turns as usize,
            };
            Some(silent::measure(&mut dispatch, &mut load, plan).await?)
        }
        None => None,
    };
    dispatch.close().await?;
    drop(workers);
    Ok(Object { result, silent })
}
