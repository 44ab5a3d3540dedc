//! Tests of certificates and access control over QUIC, on loopback, with real processes.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of a test suite: to panic is to fail the test"
)]
mod access;
mod admission;
mod stranger;

use dispatch::runtime::{Dispatch, DispatchOptions};
use journal::event::JobReason;
use protocol::{id::JobId, job::Outcome};
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    process::Command,
    time::Duration,
};
use tests::process::worker_program;

const LIMIT: Duration = Duration::from_mins(1);

/// Returns options of a run that listens with the given key material.
fn options(run_dir: &Path, locator: &str, keys: &Path, local_workers: usize) -> DispatchOptions {
    let mut options = tests::options(run_dir, Some(locator), local_workers);
    options.access.tls = Some(keys.to_owned());
    options
}

/// Returns a command that starts a worker with the given key material, if any.
fn worker(locator: &str, tls: Option<PathBuf>, arguments: &[&str]) -> Command {
    let mut command = Command::new(worker_program());
    command
        .args(["--connect", locator])
        .args(arguments)
        .env_remove("HORSEHEAD_TLS");
    if let Some(tls) = tls {
        command.arg("--tls").arg(tls);
    }
    command
}

/// Submits jobs to a coordinator and waits for the results of all.
async fn compute(dispatch: &mut Dispatch, jobs: u64, delay_ms: u32) -> BTreeMap<JobId, Outcome> {
    for n in 0..jobs {
        dispatch
            .submit(JobId(n), tests::job(n, delay_ms), JobReason::default())
            .unwrap();
    }
    let mut results = BTreeMap::new();
    let all = async {
        while (results.len() as u64) < jobs {
            let completed = dispatch.next().await.unwrap();
            results.insert(completed.id, completed.outcome);
        }
    };
    let in_time = tokio::time::timeout(LIMIT, all).await;
    assert_eq!(in_time, Ok(()), "{:?}", dispatch.snapshot());
    results
}
