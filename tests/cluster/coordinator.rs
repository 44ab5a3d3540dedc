//! Coordinator program for the cluster tests, which kill it: writes a line for each result.
//!
//! `test-coordinator RUN_DIR LOCATOR JOBS DELAY_MS LOCAL_WORKERS` does a number of jobs; each line is `id
//! replayed`. With `search:SEED` for JOBS it runs a search and leaves its log in `RUN_DIR/log`.
use dispatch::runtime::Dispatch;
use journal::event::JobReason;
use protocol::id::JobId;
use std::{
    env,
    error::Error,
    fs,
    io::{self, Write},
    path::Path,
    process::ExitCode,
    time::Duration,
};
use tests::search_run::SearchRun;

#[tokio::main]
async fn main() -> ExitCode {
    match run().await {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // whoever started it reads that, or is no longer there
            drop(writeln!(io::stderr(), "{error}"));
            ExitCode::FAILURE
        }
    }
}

async fn run() -> Result<(), Box<dyn Error>> {
    tracing_subscriber::fmt()
        .with_writer(io::stderr)
        .with_max_level(tracing_subscriber::filter::LevelFilter::WARN)
        .init();
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [run_dir, locator, jobs, delay_ms, local] = arguments.as_slice() else {
        return Err("expected RUN_DIR LOCATOR JOBS DELAY_MS LOCAL_WORKERS".into());
    };
    let listen = (locator != "none").then_some(locator.as_str());
    let mut options = tests::options(Path::new(run_dir), listen, local.parse()?);
    if let Ok(seconds) = env::var("HORSEHEAD_TEST_PAUSE_LIMIT_S") {
        options.pause_limit = Duration::from_secs(seconds.parse()?);
    }
    let mut dispatch = Dispatch::open(options).await?;
    let mut out = io::stdout();
    let delay_ms: u32 = delay_ms.parse()?;
    if let Some(seed) = jobs.strip_prefix("search:") {
        let mut search = SearchRun::new(seed.parse()?, delay_ms);
        while search.strategy.finished().is_none() {
            for (id, job) in search.ask() {
                dispatch.submit(JobId(id), job, JobReason::default())?;
            }
            let completed = dispatch.next().await?;
            search.tell(completed.id.0, &completed.outcome);
            writeln!(out, "{} {}", completed.id, completed.replayed)?;
        }
        fs::write(Path::new(run_dir).join("log"), search.log())?;
    } else {
        let jobs: u64 = jobs.parse()?;
        for n in 0..jobs {
            dispatch.submit(JobId(n), tests::job(n, delay_ms), JobReason::default())?;
        }
        for _ in 0..jobs {
            let completed = match dispatch.next().await {
                Ok(completed) => completed,
                Err(error) => {
                    dispatch.close().await?;
                    return Err(error.into());
                }
            };
            writeln!(out, "{} {}", completed.id, completed.replayed)?;
            out.flush()?;
        }
    }
    let summary = dispatch.close().await?;
    writeln!(
        out,
        "done repeated {} replayed {} lost {}",
        summary.last.repeated, summary.replayed, summary.last.lost
    )?;
    Ok(())
}
