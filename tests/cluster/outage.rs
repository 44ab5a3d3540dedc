//! Workers outlive their coordinator: they go on, come back, and hand in what they finished.
//!
//! `HORSEHEAD_TEST_OUTAGE_S` sets how long the coordinator is gone (default 6 s).
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

#[test]
fn workers_come_back_after_an_outage_and_nothing_is_computed_twice() {
    let outage: u64 = env::var("HORSEHEAD_TEST_OUTAGE_S")
        .ok()
        .map_or(6, |seconds| seconds.parse().unwrap());
    let folder = tempfile::tempdir().unwrap();
    let (run_dir, trace) = (folder.path().join("run"), folder.path().join("trace"));
    let locator = free_locator();
    let trace_to = trace.to_str().unwrap();
    let workers: Vec<Process> = (0..2)
        .map(|_| {
            let environment = [("HORSEHEAD_TEST_TRACE", trace_to)];
            Process::worker_with(&locator, &["--slots", "2"], &environment)
        })
        .collect();
    let mut first = coordinator(&run_dir, &locator);
    let mut lines = BufReader::new(first.output()).lines();
    for _ in 0..6 {
        lines.next().unwrap().unwrap();
    }
    first.signal(Signal::KILL);
    drop(first);
    thread::sleep(Duration::from_secs(outage));
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
    eprintln!("after {outage} s of outage the first result came in {fresh_after:?}");
    assert!(fresh_after <= Duration::from_secs(5), "{fresh_after:?}");
    assert!(last.starts_with("done repeated 0 "), "{last}");
    let mut times: BTreeMap<u64, u32> = BTreeMap::new();
    for line in fs::read_to_string(&trace).unwrap().lines() {
        *times.entry(line.parse().unwrap()).or_default() += 1;
    }
    assert_eq!(times.len(), 24);
    assert!(times.values().all(|times| *times == 1), "{times:?}");
    drop(workers);
}
