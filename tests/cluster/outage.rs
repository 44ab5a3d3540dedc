//! Tests in which workers outlive a coordinator that is killed or frozen: they keep computing, reconnect and
//! deliver their results.
//!
//! `HORSEHEAD_TEST_OUTAGE_S` sets the length of the outage (default 6 s, longer than every lease: that of the
//! transport is 3 s, and a worker is declared lost after 4 s of silence).
use super::LIMIT;
use rustix::process::Signal;
use std::{
    collections::BTreeMap,
    env, fs,
    io::{BufRead, BufReader},
    path::Path,
    process::Command,
    thread,
    time::{Duration, Instant},
};
use tests::process::{Process, free_locator};

fn coordinator(run_dir: &Path, locator: &str) -> Process {
    let mut command = Command::new(env!("CARGO_BIN_EXE_test-coordinator"));
    command.arg(run_dir).args([locator, "24", "700", "0"]);
    Process::start(command)
}

fn outage() -> Duration {
    let seconds = env::var("HORSEHEAD_TEST_OUTAGE_S");
    Duration::from_secs(seconds.ok().map_or(6, |seconds| seconds.parse().unwrap()))
}

/// Starts two workers of two slots that record the jobs they compute in a trace file.
fn workers(locator: &str, trace: &Path) -> [Process; 2] {
    let environment = [("HORSEHEAD_TEST_TRACE", trace.to_str().unwrap())];
    [(); 2].map(|()| Process::worker_with(locator, &["--slots", "2"], &environment))
}

fn expect_computed_once(trace: &Path) {
    let mut times: BTreeMap<u64, u32> = BTreeMap::new();
    for line in fs::read_to_string(trace).unwrap().lines() {
        *times.entry(line.parse().unwrap()).or_default() += 1;
    }
    assert_eq!(times.len(), 24);
    assert!(times.values().all(|times| *times == 1), "{times:?}");
}

#[test]
fn workers_come_back_after_an_outage_and_nothing_is_computed_twice() {
    let folder = tempfile::tempdir().unwrap();
    let (run_dir, trace) = (folder.path().join("run"), folder.path().join("trace"));
    let locator = free_locator();
    let workers = workers(&locator, &trace);
    let mut first = coordinator(&run_dir, &locator);
    let mut lines = BufReader::new(first.output()).lines();
    for _ in 0..6 {
        lines.next().unwrap().unwrap();
    }
    first.signal(Signal::KILL);
    drop(first);
    thread::sleep(outage());
    let back = Instant::now();
    let mut second = coordinator(&run_dir, &locator);
    let mut fresh_after = None;
    let mut last = String::new();
    for line in BufReader::new(second.output()).lines() {
        last = line.unwrap();
        if last.ends_with(" false") && fresh_after.is_none() {
            fresh_after = Some(back.elapsed());
        }
    }
    let fresh_after = fresh_after.unwrap();
    eprintln!(
        "after an outage of {:?} the first result came in {fresh_after:?}",
        outage()
    );
    // it takes a second where nothing else runs; workers that had to be told would never come
    assert!(fresh_after <= LIMIT / 4, "{fresh_after:?}");
    assert!(last.starts_with("done repeated 0 "), "{last}");
    expect_computed_once(&trace);
    drop(workers);
}

/// Checks that a coordinator that was frozen (Ctrl-Z and `fg`, or migration of a virtual machine) declares no
/// worker lost, although the workers closed their connections while it did not answer.
#[test]
fn a_coordinator_that_was_frozen_blames_nobody_and_repeats_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (run_dir, trace) = (folder.path().join("run"), folder.path().join("trace"));
    let locator = free_locator();
    let workers = workers(&locator, &trace);
    let mut process = coordinator(&run_dir, &locator);
    let mut lines = BufReader::new(process.output()).lines();
    for _ in 0..6 {
        lines.next().unwrap().unwrap();
    }
    process.signal(Signal::STOP);
    thread::sleep(outage());
    process.signal(Signal::CONT);
    let last = lines.map_while(Result::ok).last().unwrap();
    assert_eq!(last, "done repeated 0 replayed 0 lost 0");
    expect_computed_once(&trace);
    drop(workers);
}
