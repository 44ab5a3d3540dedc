//! A coordinator for the cluster suite: does a number of jobs and writes a line for each result.
//!
//! `test-coordinator RUN_DIR LOCATOR JOBS DELAY_MS LOCAL_WORKERS`; each line is `id replayed`.
use coordinator::runtime::Dispatch;
use protocol::id::JobId;
use std::{
    env,
    error::Error,
    io::{self, Write},
    path::Path,
};

#[tokio::main]
async fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [run_dir, locator, jobs, delay_ms, local] = arguments.as_slice() else {
        return Err("expected RUN_DIR LOCATOR JOBS DELAY_MS LOCAL_WORKERS".into());
    };
    let (jobs, delay_ms): (u64, u32) = (jobs.parse()?, delay_ms.parse()?);
    let options = tests::options(Path::new(run_dir), Some(locator), local.parse()?);
    let mut dispatch = Dispatch::open(options).await?;
    for n in 0..jobs {
        dispatch.submit(JobId(n), tests::job(n, delay_ms))?;
    }
    let mut out = io::stdout();
    for _ in 0..jobs {
        let completed = dispatch.next().await?;
        writeln!(out, "{} {}", completed.id, completed.replayed)?;
        out.flush()?;
    }
    let summary = dispatch.close().await?;
    writeln!(
        out,
        "done repeated {} replayed {}",
        summary.last.repeated, summary.replayed
    )?;
    Ok(())
}
