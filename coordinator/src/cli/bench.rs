//! `horsehead bench`: what the machinery costs without physics, and what accuracy costs with it.
use super::{EXIT_CODES, Output, OutputChoice, bus, integrators, output};
use clap::{Args, Subcommand};

/// Measure what the machinery costs, or what accuracy costs.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// The bus alone: no-op jobs to local workers.
    #[command(after_help = format!("Example:\n  horsehead bench dispatch --workers 2 --jobs 20000\n\n{EXIT_CODES}"))]
    Dispatch {
        /// Worker processes to start.
        #[arg(long, value_name = "N", default_value_t = 2, env = "HORSEHEAD_WORKERS", value_parser = super::worker_count())]
        workers: usize,
        /// Jobs to do.
        #[arg(long, value_name = "N", default_value_t = 10_000)]
        jobs: usize,
        #[command(flatten)]
        output: OutputChoice,
    },
    Integrators(integrators::Arguments),
}

/// Measures and shows.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.what {
        What::Dispatch {
            workers,
            jobs,
            output: OutputChoice { output },
        } => dispatch(*workers, *jobs, *output),
        What::Integrators(arguments) => integrators::run(arguments),
    }
}

fn dispatch(workers: usize, jobs: usize, output: Output) -> anyhow::Result<()> {
    if output == Output::Table {
        output::tell(&format!("{jobs} no-op jobs on {workers} workers"));
    }
    let result = bus::block_on(bus::bench(workers, jobs))?;
    let table = || {
        format!(
            "round trip   {:>10.3} ms median, {:.3} ms at 99 %\n\
             throughput   {:>10.0} jobs/s\n\
             coordinator  {:>10.1} us CPU per job, {:.1} MiB\n",
            result.rtt_ms.median,
            result.rtt_ms.p99,
            result.jobs_per_s,
            result.coordinator_cpu_us_per_job,
            result.coordinator_rss_mib
        )
    };
    output::print(output, table, &result)
}
