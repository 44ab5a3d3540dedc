//! Tests with a coordinator that is killed and restarted with the same command.
use super::LIMIT;
use journal::event::Event;
use protocol::{id::JobId, job::Outcome};
use rustix::process::Signal;
use std::{
    collections::BTreeMap,
    fs,
    io::{BufRead, BufReader, Read},
    path::Path,
    process::Command,
};
use tests::{
    expect_results,
    process::{Process, children, free_locator, is_alive, wait_until},
};

fn coordinator(run_dir: &Path, locator: &str, jobs: u64, local: usize) -> Process {
    let mut command = Command::new(env!("CARGO_BIN_EXE_test-coordinator"));
    let (jobs, local) = (jobs.to_string(), local.to_string());
    command.arg(run_dir).args([locator, &jobs, "20", &local]);
    Process::start(command)
}

/// Returns the results recorded in the journal, by job, and their total number, which reveals duplicates.
fn recorded(run_dir: &Path) -> (BTreeMap<JobId, Outcome>, usize) {
    let (mut results, mut records) = (BTreeMap::new(), 0);
    journal::fold(&run_dir.join(journal::FILE), |_, event| {
        if let Event::Finished(finished) = event {
            records += 1;
            results.insert(finished.job(), finished.outcome);
        }
    })
    .unwrap();
    (results, records)
}

/// Kills a coordinator repeatedly while its workers stay, and checks that no recorded result is computed
/// again and that the final results are complete.
#[test]
fn a_killed_coordinator_goes_on_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    let workers: Vec<Process> = (0..2)
        .map(|_| Process::worker(&locator, &["--slots", "2"]))
        .collect();
    let mut known = 0;
    for round in 0..3_usize {
        let mut process = coordinator(folder.path(), &locator, 200, 0);
        let mut lines = BufReader::new(process.output()).lines();
        // kill it after as many new results, wherever it is then
        for _ in 0..known + 30 + 7 * round {
            lines.next().unwrap().unwrap();
        }
        process.signal(Signal::KILL);
        drop(process);
        let (results, records) = recorded(folder.path());
        assert_eq!(results.len(), records, "no job was recorded twice");
        assert!(records > known, "round {round}");
        known = records;
    }
    let mut last = coordinator(folder.path(), &locator, 200, 0);
    let mut said = String::new();
    last.output().read_to_string(&mut said).unwrap();
    assert_eq!(last.wait(LIMIT), Some(0), "{said}");
    let (results, records) = recorded(folder.path());
    assert_eq!(records, 200, "no job was recorded twice");
    expect_results(&results, 200);
    let replayed = said.lines().filter(|line| line.ends_with(" true")).count();
    assert_eq!(replayed, known, "every recorded result was used");
    drop(workers);
}

/// Checks that local workers and their slots end with their coordinator, even when it is killed.
#[test]
fn a_killed_coordinator_leaves_no_process_behind() {
    let folder = tempfile::tempdir().unwrap();
    let mut process = coordinator(folder.path(), &free_locator(), 100_000, 2);
    let mut lines = BufReader::new(process.output()).lines();
    for _ in 0..20 {
        lines.next().unwrap().unwrap();
    }
    let (mut workers, mut slots) = (Vec::new(), Vec::new());
    // on a busy machine one worker computes before the other has begun
    wait_until("two workers have a slot each", LIMIT, || {
        workers = children(process.pid());
        slots = workers.iter().flat_map(|pid| children(*pid)).collect();
        (workers.len(), slots.len()) == (2, 2)
    });
    process.signal(Signal::KILL);
    wait_until("all are gone", LIMIT, || {
        workers.iter().chain(&slots).all(|pid| !is_alive(*pid))
    });
    assert!(
        fs::metadata(folder.path().join(journal::FILE))
            .unwrap()
            .len()
            > 0
    );
}
