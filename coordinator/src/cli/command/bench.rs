//! `horsehead bench`: measures the overhead of job dispatch with no-op jobs, without simulation.
use crate::cli::{
    argument::output::{Output, OutputChoice},
    output::{problem::EXIT_CODES, terminal},
};
use clap::{Args, Subcommand};
use dispatch::{
    bench::{self, BenchPlan},
    runtime::DispatchOptions,
};
use protocol::case::Case;
use run::{message, session::dispatcher};
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
Example:
  horsehead bench dispatch --workers 2 --jobs 20000

{EXIT_CODES}"))]
    Dispatch {
        /// Worker processes to start, each with one slot process.
        #[arg(long, value_name = "N", default_value_t = 2, env = "HORSEHEAD_WORKERS", value_parser = clap::value_parser!(u32).range(1..=1024))]
        workers: u32,
        /// Number of jobs to run.
        #[arg(long, value_name = "N", default_value_t = 10_000, env = "HORSEHEAD_JOBS", value_parser = clap::value_parser!(u64).range(1..))]
        jobs: u64,
        /// Bytes of each result: a score has about 300, one with its residual 10,000.
        #[arg(long, value_name = "N", default_value_t = 10_000, env = "HORSEHEAD_RESULT_BYTES", value_parser = clap::value_parser!(u32).range(..=10_000_000))]
        result_bytes: u32,
        #[command(flatten)]
        output: OutputChoice,
    },
}

/// Runs the benchmark of job dispatch and prints its result.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let Benchmark::Dispatch {
        workers,
        jobs,
        result_bytes,
        output: OutputChoice { output },
    } = &arguments.what;
    if *output == Output::Table {
        message::print(&format!("{jobs} no-op jobs on {workers} worker processes"));
    }
    let plan = BenchPlan {
        workers: *workers as usize,
        jobs: *jobs,
        result_bytes: *result_bytes,
    };
    let scratch = tempfile::tempdir()?;
    let (case, settings) = (Case::default(), "{}".to_owned());
    let options = DispatchOptions::local(scratch.path(), 0, &case, "bench", settings)?;
    let result = dispatcher::block_on(async {
        let result = bench::measure(options, plan).await;
        Ok(result.map_err(EvaluatorError::from)?)
    })?;
    let table = || {
        format!(
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
        )
    };
    terminal::print(*output, table, &result)
}
