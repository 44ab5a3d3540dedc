//! Tests with local workers that end: they are restarted while the run makes progress, and given up with one
//! clear message when it cannot.
use super::LIMIT;
use std::{
    fs,
    io::{BufRead, BufReader, Read},
    os::unix::fs::PermissionsExt,
    path::Path,
    process::{Command, Stdio},
};
use tests::process::{Process, worker_program};

/// Exit status and output of a run that has only local workers.
struct Ended {
    status: Option<i32>,
    lines: Vec<String>,
    errors: String,
}

/// Runs jobs of 5 ms on local workers that have an additional environment variable.
fn run(folder: &Path, jobs: u64, workers: usize, environment: (&str, &str)) -> Ended {
    let mut command = Command::new(env!("CARGO_BIN_EXE_test-coordinator"));
    command
        .arg(folder.join("run"))
        .args(["none", &jobs.to_string(), "5", &workers.to_string()])
        .env("HORSEHEAD_WORKER", worker_program())
        .env(environment.0, environment.1)
        .stderr(Stdio::piped());
    let mut process = Process::start(command);
    let mut errors = process.errors();
    let listener = std::thread::spawn(move || {
        let mut text = String::new();
        // what is no text is not of ours
        drop(errors.read_to_string(&mut text));
        text
    });
    let lines = BufReader::new(process.output()).lines();
    let lines = lines.map_while(Result::ok).collect();
    Ended {
        status: process.wait(LIMIT),
        lines,
        errors: listener.join().unwrap(),
    }
}

/// Checks that jobs that kill every worker cost no other job and never become results: the run ends without them, and
/// the same command computes them once their cause is removed.
#[test]
fn jobs_that_kill_local_workers_cost_only_themselves_and_are_no_results() {
    let folder = tempfile::tempdir().unwrap();
    let killers = [3, 5, 7];
    let words = killers.map(|job| format!("{job}:kill-worker")).join(",");
    let ended = run(folder.path(), 12, 2, ("HORSEHEAD_TEST_MISBEHAVE", &words));
    assert_eq!(ended.status, Some(1), "{}", ended.errors);
    let computed = |ended: &Ended, how: &str| {
        let jobs = ended.lines.iter();
        let mut jobs: Vec<u64> = jobs
            .filter_map(|line| line.strip_suffix(how)?.parse().ok())
            .collect();
        jobs.sort_unstable();
        jobs
    };
    let others: Vec<u64> = (0..12).filter(|job| !killers.contains(job)).collect();
    assert_eq!(computed(&ended, " false"), others, "{}", ended.errors);
    let words = "waits for a worker that joins from now on: 4 workers that held it were lost";
    assert!(ended.errors.contains(words), "{}", ended.errors);
    assert!(!ended.errors.contains("was abandoned"), "{}", ended.errors);
    let ended = run(folder.path(), 12, 2, ("HORSEHEAD_TEST_MISBEHAVE", ""));
    assert_eq!(ended.status, Some(0), "{}", ended.errors);
    assert_eq!(computed(&ended, " true"), others);
    assert_eq!(computed(&ended, " false"), killers);
}

#[test]
fn if_every_job_kills_its_worker_the_run_stops_with_one_message() {
    let folder = tempfile::tempdir().unwrap();
    let killers: Vec<String> = (0..20).map(|n| format!("{n}:kill-worker")).collect();
    let killers = killers.join(",");
    let ended = run(folder.path(), 20, 4, ("HORSEHEAD_TEST_MISBEHAVE", &killers));
    assert_eq!(ended.status, Some(1), "{}", ended.errors);
    let words =
        "the local workers keep ending without a result (the last one was ended by signal 9)";
    assert_eq!(ended.errors.matches(words).count(), 1, "{}", ended.errors);
}

#[test]
fn if_no_local_worker_lives_the_run_says_so_instead_of_waiting() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("worker");
    fs::write(&program, "#!/bin/sh\necho no libc here >&2\nexit 7\n").unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let program = program.to_str().unwrap();
    let ended = run(folder.path(), 3, 2, ("HORSEHEAD_WORKER", program));
    assert_eq!(ended.status, Some(1), "{}", ended.errors);
    let words = "the local workers keep ending without a result (the last one ended with \
                 status 7: `no libc here`)";
    assert_eq!(ended.errors.matches(words).count(), 1, "{}", ended.errors);
}
