//! Coordinator program for the network suite: runs jobs on workers with certificates, and prints each change
//! of its state with the time.
//!
//! `test-network-coordinator RUN_DIR LOCATOR KEYS JOBS DELAY_MS`; each line is `MS workers N done N lost N
//! repeated N duplicates N`, the last one begins with `end`. Exits with an error if a job has an unexpected
//! result.
use dispatch::runtime::{Dispatch, Snapshot};
use journal::event::JobReason;
use protocol::id::JobId;
use std::{
    collections::BTreeMap,
    env,
    error::Error,
    io::{self, Write},
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

/// Interval at which the coordinator's state is sampled.
const LOOK: Duration = Duration::from_millis(50);

#[tokio::main]
async fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [run_dir, locator, keys, jobs, delay_ms] = arguments.as_slice() else {
        return Err("expected RUN_DIR LOCATOR KEYS JOBS DELAY_MS".into());
    };
    let (jobs, delay_ms): (u64, u32) = (jobs.parse()?, delay_ms.parse()?);
    let begun = Instant::now();
    let mut options = tests::options(Path::new(run_dir), Some(locator), 0);
    options.access.tls = Some(PathBuf::from(keys));
    let mut dispatch = Dispatch::open(options).await?;
    for n in 0..jobs {
        dispatch.submit(JobId(n), tests::job(n, delay_ms), JobReason::default())?;
    }
    let (mut results, mut last) = (BTreeMap::new(), String::new());
    let mut looks = tokio::time::interval(LOOK);
    while (results.len() as u64) < jobs {
        tokio::select! {
            completed = dispatch.next() => {
                let completed = completed?;
                if results.insert(completed.id, completed.outcome).is_some() {
                    return Err(format!("job {} was delivered twice", completed.id).into());
                }
            }
            _ = looks.tick() => {
                let line = describe(&dispatch.snapshot());
                if line != last {
                    say(&format!("{} {line}", begun.elapsed().as_millis()))?;
                    last = line;
                }
            }
        }
    }
    tests::expect_results(&results, jobs);
    let took = begun.elapsed().as_millis();
    let summary = dispatch.close().await?;
    say(&format!("end {took} {}", describe(&summary.last)))?;
    Ok(())
}

fn describe(state: &Snapshot) -> String {
    format!(
        "workers {} done {} lost {} repeated {} duplicates {}",
        state.workers.len(),
        state.done,
        state.lost,
        state.repeated,
        state.duplicates
    )
}

fn say(line: &str) -> io::Result<()> {
    let mut out = io::stdout();
    writeln!(out, "{line}")?;
    out.flush()
}
