//! Checks that leases, deadlines and journal use the monotonic clock: the wall clock is set forwards and
//! backwards during a run.
//!
//! The clock of the machine is shared, so the programs under test are given a false time instead: a small
//! library (`wall_clock.c`), preloaded before their own libraries.
use rustix::process::Signal;
use std::{
    io::{BufRead, BufReader},
    path::{Path, PathBuf},
    process::Command,
    thread,
    time::Duration,
};
use tests::process::{Process, free_locator, worker_program};

/// Builds the preloaded library with the compiler that also links Rust programs.
fn library(folder: &Path) -> PathBuf {
    let built = folder.join("wall_clock.so");
    let status = Command::new("cc")
        .args(["-shared", "-fPIC", "-O1", "-o"])
        .arg(&built)
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/cluster/wall_clock.c"))
        .status();
    assert!(status.is_ok_and(|status| status.success()), "cc");
    built
}

/// Returns the time of day that a program with the preloaded library sees \[s\].
fn shown(library: &Path) -> i64 {
    let output = Command::new("date")
        .arg("+%s")
        .env("LD_PRELOAD", library)
        .output();
    let text = String::from_utf8(output.unwrap().stdout).unwrap();
    text.trim().parse().unwrap()
}

#[test]
fn a_wall_clock_that_jumps_costs_nothing() {
    const JOBS: usize = 64;
    let folder = tempfile::tempdir().unwrap();
    let library = library(folder.path());
    let start = |program: &Path, arguments: &[&str]| {
        let mut command = Command::new(program);
        command.args(arguments).env("LD_PRELOAD", &library);
        Process::start(command)
    };
    let locator = free_locator();
    let worker = ["--connect", &locator, "--slots", "2"];
    let workers = [(); 2].map(|()| start(&worker_program(), &worker));
    let run = folder.path().join("run");
    let (run, jobs) = (run.to_str().unwrap(), JOBS.to_string());
    let coordinator = Path::new(env!("CARGO_BIN_EXE_test-coordinator"));
    let mut process = start(coordinator, &[run, &locator, &jobs, "300", "0"]);
    let reader = {
        let output = process.output();
        thread::spawn(move || {
            BufReader::new(output)
                .lines()
                .map_while(Result::ok)
                .collect()
        })
    };
    let mut seen = Vec::new();
    while !reader.is_finished() {
        seen.push(shown(&library));
        thread::sleep(Duration::from_millis(100));
    }
    let lines: Vec<String> = reader.join().unwrap();
    assert_eq!(lines.len(), JOBS + 1, "{lines:?}");
    assert_eq!(lines[JOBS], "done repeated 0 replayed 0 lost 0");
    let ahead = seen.windows(2).filter(|pair| pair[1] > pair[0] + 1_000_000);
    let back = seen.windows(2).filter(|pair| pair[1] < pair[0] - 1_000_000);
    let (ahead, back) = (ahead.count(), back.count());
    assert!(
        ahead > 0 && back > 0,
        "the clock was right all the time: {seen:?}"
    );
    // the journal is whole, and the same command has nothing left to do
    let mut again = start(coordinator, &[run, &locator, &jobs, "300", "0"]);
    let replayed = BufReader::new(again.output())
        .lines()
        .map_while(Result::ok)
        .last();
    assert_eq!(
        replayed.unwrap(),
        format!("done repeated 0 replayed {JOBS} lost 0")
    );
    for worker in &workers {
        worker.signal(Signal::TERM);
    }
}
