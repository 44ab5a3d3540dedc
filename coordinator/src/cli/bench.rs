//! `horsehead bench`: what the machinery costs without physics, and what accuracy costs with it.
use super::{
    EXIT_CODES, Output, OutputChoice, bus, integrators, json::SilentOutput, output, whole_box,
};
use crate::runtime::{self, BenchPlan, Crew, Silence, SilentPlan};
use clap::{Args, Subcommand};
use link::locator::Locator;
use std::path::PathBuf;

/// Measure what the machinery costs, or what accuracy costs.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
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
        /// Instead of processes, so many workers that are only sessions within this process, over
        /// the memory link: no transport and no slots, the rest is real.
        #[arg(long, value_name = "N", env = "HORSEHEAD_SESSIONS", value_parser = clap::value_parser!(u32).range(1..=16_384))]
        sessions: Option<u32>,
        /// Instead of processes, so many workers that are only sessions of one other process, over
        /// TCP on loopback: no slots, the rest is real.
        #[arg(long, value_name = "N", conflicts_with = "sessions", env = "HORSEHEAD_CONNECTIONS", value_parser = clap::value_parser!(u32).range(1..=990))]
        connections: Option<u32>,
        /// Have those connections come over QUIC instead of TCP, with the certificate of `worker-01` of
        /// this folder of `horsehead keys new DIR --host 127.0.0.1`; nothing without --connections or
        /// with --silent or --idle.
        #[arg(long, value_name = "DIR", env = "HORSEHEAD_TLS")]
        tls: Option<PathBuf>,
        /// Jobs to do.
        #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u64).range(1..))]
        jobs: u64,
        /// Bytes of each result: a score has about 300, one with its residual 10,000.
        #[arg(long, value_name = "N", default_value_t = 10_000, env = "HORSEHEAD_RESULT_BYTES", value_parser = clap::value_parser!(u32).range(..=10_000_000))]
        result_bytes: u32,
        /// Measure too, in turn without and with them, what so many connections cost that say
        /// nothing and are opened again whenever the coordinator closes them.
        #[arg(long, value_name = "N", conflicts_with = "sessions", env = "HORSEHEAD_SILENT", value_parser = clap::value_parser!(u32).range(1..=8000))]
        silent: Option<u32>,
        /// The same with sessions of the bus that never announce themselves: the coordinator takes
        /// 1,000 sessions in all.
        #[arg(long, value_name = "N", conflicts_with_all = ["sessions", "silent"], env = "HORSEHEAD_IDLE", value_parser = clap::value_parser!(u32).range(1..=990))]
        idle: Option<u32>,
        /// How often, with --silent or --idle: 8 s without and 8 s with them each time.
        #[arg(long, value_name = "N", default_value_t = 5, env = "HORSEHEAD_TURNS", value_parser = clap::value_parser!(u32).range(1..=1000))]
        turns: u32,
        #[command(flatten)]
        output: OutputChoice,
    },
    Integrators(integrators::Arguments),
    Box(whole_box::Arguments),
    /// Be many workers that are only sessions, for `bench dispatch --connections`.
    #[command(hide = true, after_help = format!("\
Example:
  horsehead bench sessions tcp/127.0.0.1:7447 64

{EXIT_CODES}"))]
    Sessions {
        /// Address to dial.
        #[arg(value_name = "LOCATOR", value_parser = Locator::parse)]
        connect: Locator,
        /// How many.
        #[arg(value_name = "N")]
        sessions: usize,
        /// Key material of a worker.
        #[arg(long, value_name = "DIR", env = "HORSEHEAD_TLS")]
        tls: Option<PathBuf>,
    },
    /// Hold connections that say nothing, for `bench dispatch` with `--silent` or `--idle`, until
    /// standard input ends.
    #[command(hide = true, after_help = format!("\
Example:
  horsehead bench silent tcp/127.0.0.1:7447 5000

{EXIT_CODES}"))]
    Silent {
        /// Address to dial.
        #[arg(value_name = "LOCATOR", value_parser = Locator::parse)]
        connect: Locator,
        /// How many.
        #[arg(value_name = "N")]
        connections: usize,
        /// Open a session of the bus on each.
        #[arg(long, env = "HORSEHEAD_OPENED")]
        opened: bool,
    },
}

/// Measures and shows.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.what {
        What::Dispatch {
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
                    Crew::Sessions,
                    *sessions,
                    "sessions of this process (memory link)",
                ),
                (None, Some(connections)) => (
                    Crew::Connections,
                    *connections,
                    match &tls {
                        Some(_) => "sessions of another process (QUIC on loopback)",
                        None => "sessions of another process (TCP on loopback)",
                    },
                ),
                (None, None) => (
                    Crew::Processes,
                    *workers,
                    "worker processes (TCP on loopback)",
                ),
            };
            let plan = BenchPlan {
                crew,
                workers: workers as usize,
                jobs: *jobs,
                result_bytes: *result_bytes,
                silent: silent.or(*idle).map(|connections| SilentPlan {
                    silence: match idle {
                        None => Silence::Connection,
                        Some(_) => Silence::Session,
                    },
                    connections: connections as usize,
                    turns: *turns as usize,
                }),
            };
            dispatch(plan, tls, of_what, *output)
        }
        What::Integrators(arguments) => integrators::run(arguments),
        What::Box(arguments) => whole_box::run(arguments),
        What::Sessions {
            connect,
            sessions,
            tls,
        } => {
            bus::block_on(async { Ok(runtime::connect(connect, *sessions, tls.as_deref()).await?) })
        }
        What::Silent {
            connect,
            connections,
            opened,
        } => {
            let silence = if *opened {
                Silence::Session
            } else {
                Silence::Connection
            };
            bus::block_on(async { Ok(runtime::keep_silent(connect, silence, *connections).await?) })
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
        output::tell(&format!("{jobs} no-op jobs on {workers} {of_what}"));
    }
    let result = bus::block_on(bus::bench(plan, tls))?;
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
            text += &beside(silent);
        }
        text
    };
    output::print(output, table, &result)
}

fn beside(silent: &SilentOutput) -> String {
    let [smallest, largest] = silent.rate_ratio_range;
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
