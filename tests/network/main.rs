//! Tests over real networks between namespaces of this machine: unreliable and interrupted links, and a
//! machine with overloaded processors.
//!
//! Needs Linux, root and iproute2; skipped with a message where these are missing.
#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of a test suite: to panic is to fail the test"
)]
use rustix::process::{Pid, Signal};
use std::{
    fs,
    io::{BufRead, BufReader, Lines},
    path::{Path, PathBuf},
    process::{ChildStdout, Command},
    sync::{PoisonError, RwLock, RwLockReadGuard},
    thread,
    time::{Duration, Instant},
};
use tests::{
    keys::make,
    namespace::{HEAD, Namespaces},
    process::{Process, worker_program},
};

const LIMIT: Duration = Duration::from_mins(1);
/// UDP port of the coordinator. `BAD_PORT` is the port of the unreliable relay in front of it.
const PORT: u16 = 7447;
const BAD_PORT: u16 = 7448;
/// Silence after which a worker counts as lost \[ms\].
const SILENCE_MS: u64 = 4000;

/// Lock that lets the test that overloads the machine run alone (write lock); the other tests, which mostly
/// wait, hold it shared.
static BUSY: RwLock<()> = RwLock::new(());

/// Coordinator running in the network namespace called head, with its output, the namespaces and key
/// material.
struct Testbed {
    // the processes end before what they stand on
    coordinator: Process,
    lines: Lines<BufReader<ChildStdout>>,
    namespaces: Namespaces,
    folder: tempfile::TempDir,
}

/// Time and counts of workers and jobs that the coordinator printed in one line.
#[derive(Clone, Copy, Debug)]
struct State {
    ms: u64,
    workers: u64,
    done: u64,
    lost: u64,
    repeated: u64,
    duplicates: u64,
    is_end: bool,
}

impl State {
    fn read(line: &str) -> Self {
        let is_end = line.starts_with("end ");
        let words: Vec<&str> = line.trim_start_matches("end ").split(' ').collect();
        let number = |at: usize| words[at].parse().unwrap();
        Self {
            ms: number(0),
            workers: number(2),
            done: number(4),
            lost: number(6),
            repeated: number(8),
            duplicates: number(10),
            is_end,
        }
    }
}

impl Testbed {
    /// Starts a coordinator with this number of jobs in the network namespace called head; returns `None` if
    /// the machine supports no namespaces.
    fn set(jobs: u64, delay_ms: u64) -> Option<Self> {
        worker_program();
        let namespaces = Namespaces::make()?;
        let folder = tempfile::tempdir().unwrap();
        let keys = folder.path().join("keys");
        make(&keys, &[HEAD]);
        let program = Path::new(env!("CARGO_BIN_EXE_test-network-coordinator"));
        let mut command = namespaces.on_head(program);
        command.arg(folder.path().join("run"));
        command.arg(format!("quic/{HEAD}:{PORT}")).arg(&keys);
        command.args([jobs.to_string(), delay_ms.to_string()]);
        let mut coordinator = Process::start(command);
        let lines = BufReader::new(coordinator.output()).lines();
        Some(Self {
            coordinator,
            lines,
            namespaces,
            folder,
        })
    }

    fn keys(&self, name: &str) -> PathBuf {
        self.folder.path().join("keys").join(name)
    }

    /// Starts a worker in the network namespace called node, which connects to the given port of the
    /// coordinator.
    fn worker(&self, name: &str, port: u16, slots: u32) -> Process {
        let mut command = self.namespaces.on_node(&worker_program());
        command.args(["--connect", &format!("quic/{HEAD}:{port}")]);
        command.args(["--slots", &slots.to_string(), "--tls"]);
        command.arg(self.keys(name));
        Process::logged(command, &self.folder.path().join(format!("{name}.log")))
    }

    /// Reads the coordinator's lines until a state satisfies `is`, and returns that state; panics after a
    /// minute or at the end of the run.
    fn until(&mut self, what: &str, is: impl Fn(&State) -> bool) -> State {
        let begun = Instant::now();
        loop {
            let line = self
                .lines
                .next()
                .unwrap_or_else(|| panic!("ended before: {what}"));
            let state = State::read(&line.unwrap());
            if is(&state) {
                return state;
            }
            assert!(
                begun.elapsed() < LIMIT && !state.is_end,
                "{what}: {state:?}"
            );
        }
    }

    /// Reads lines until the final state, and waits for the coordinator to exit with code 0.
    fn end(mut self) -> State {
        let begun = Instant::now();
        loop {
            let line = self
                .lines
                .next()
                .unwrap_or_else(|| panic!("ended without a word"));
            let state = State::read(&line.unwrap());
            if state.is_end {
                assert_eq!(self.coordinator.wait(LIMIT), Some(0));
                return state;
            }
            assert!(begun.elapsed() < LIMIT, "no end: {state:?}");
        }
    }
}

/// Returns the time that the threads of a process spent runnable but waiting for a processor, divided by the
/// time that they ran.
fn wait_ratio(process: Pid) -> f64 {
    let threads = fs::read_dir(format!("/proc/{}/task", process.as_raw_nonzero())).unwrap();
    let (mut ran, mut waited) = (0.0, 0.0);
    for thread in threads.flatten() {
        // a thread may end at any time
        let stat = fs::read_to_string(thread.path().join("schedstat")).unwrap_or_default();
        let mut words = stat
            .split_whitespace()
            .map(|word| word.parse::<f64>().unwrap());
        ran += words.next().unwrap_or(0.0);
        waited += words.next().unwrap_or(0.0);
    }
    waited / ran
}

/// Acquires the shared lock of a test that needs a machine without artificial load.
fn calm() -> RwLockReadGuard<'static, ()> {
    BUSY.read().unwrap_or_else(PoisonError::into_inner)
}

/// Checks that results are the same over a network that, in both directions, loses a fifth of all datagrams,
/// duplicates a fifth and reorders them.
#[test]
fn a_network_that_loses_doubles_and_reorders_changes_nothing() {
    let _calm = calm();
    // so many that the second comes in before they are done: it may shake hands for ten seconds
    let Some(mut stage) = Testbed::set(1500, 5) else {
        return;
    };
    let mut command = stage
        .namespaces
        .on_head(Path::new(env!("CARGO_BIN_EXE_test-relay")));
    command.args([format!("{HEAD}:{BAD_PORT}"), format!("{HEAD}:{PORT}")]);
    command.args(["4", "0.2", "0.2", "10"]);
    let mut relay = Process::start(command);
    let mut told = BufReader::new(relay.output()).lines();
    let workers = ["worker-01", "worker-02"].map(|name| stage.worker(name, BAD_PORT, 2));
    let both = stage.until("both join", |state| state.workers == 2);
    // the coordinator has compared every result with the one that its job must have
    let end = stage.end();
    drop((workers, relay));
    let told = std::iter::from_fn(|| told.next()?.ok()).last();
    eprintln!("both joined at {} ms, {end:?}; datagrams {told:?}", both.ms);
    assert_eq!(end.done, 1500);
    let told = told.unwrap();
    let counts: Vec<u64> = told
        .split(' ')
        .filter_map(|word| word.parse().ok())
        .collect();
    assert!(
        counts.iter().all(|count| *count > 20),
        "the network was good: {told}"
    );
}

/// Checks that jobs of a worker whose cable is unplugged for eight seconds during a computation are
/// dispatched again, and that the worker rejoins.
#[test]
fn a_worker_that_was_cut_off_is_replaced_and_comes_back() {
    let _calm = calm();
    // two workers of two slots, a quarter of a second each: 16 jobs a second, 8 while one is cut off
    let Some(mut stage) = Testbed::set(180, 250) else {
        return;
    };
    let cut_off = stage.worker("worker-01", PORT, 2);
    // the other one is on the head, where no cable is pulled
    let mut command = stage.namespaces.on_head(&worker_program());
    command.args([
        "--connect",
        &format!("quic/{HEAD}:{PORT}"),
        "--slots",
        "2",
        "--tls",
    ]);
    command.arg(stage.keys("worker-02"));
    let stays = Process::logged(command, &stage.folder.path().join("stays.log"));
    stage.until("both work", |state| state.workers == 2 && state.done > 12);

    stage.namespaces.plug(false);
    let cut = Instant::now();
    let lost = stage.until("its jobs are offered again", |state| state.repeated > 0);
    let replaced = cut.elapsed();
    assert_eq!((lost.workers, lost.lost), (1, 1));
    assert!(
        replaced < Duration::from_secs(6),
        "offered again after {replaced:?}"
    );
    thread::sleep(Duration::from_secs(8).saturating_sub(cut.elapsed()));

    stage.namespaces.plug(true);
    let back = Instant::now();
    stage.until("it is back", |state| state.workers == 2);
    let returned = back.elapsed();
    assert!(returned < LIMIT / 4, "back after {returned:?}");
    let end = stage.end();
    eprintln!("offered again after {replaced:?}, back after {returned:?}, {end:?}");
    assert_eq!((end.done, end.lost), (180, 1));
    // two in its slots and two that waited: nothing else was given out twice
    assert!(end.repeated <= 4, "{end:?}");
    assert!(end.duplicates <= 4, "{end:?}");
    drop((cut_off, stays));
}

/// Checks that jobs of a killed and of a frozen worker are dispatched again within six seconds. QUIC does not
/// report the end of a process, so that both are noticed only by missing heartbeats.
#[test]
fn workers_that_are_killed_and_frozen_over_quic_are_replaced_within_six_seconds() {
    let _calm = calm();
    // three workers of two slots, a quarter of a second each: 24 jobs a second at first
    let Some(mut stage) = Testbed::set(300, 250) else {
        return;
    };
    let victims = [Signal::KILL, Signal::STOP].map(|how| (how, stage.worker("worker-01", PORT, 2)));
    let stays = stage.worker("worker-02", PORT, 2);
    stage.until("all work", |state| state.workers == 3 && state.done > 12);
    let mut before = 0;
    for (left, (how, victim)) in [2, 1].into_iter().zip(&victims) {
        victim.signal(*how);
        let at = Instant::now();
        let lost = stage.until("its jobs are offered again", |state| {
            state.repeated > before
        });
        let replaced = at.elapsed();
        eprintln!("{how:?}: offered again after {replaced:?}");
        assert_eq!((lost.workers, lost.lost), (left, 3 - left));
        assert!(
            replaced < Duration::from_secs(6),
            "{how:?}: offered again after {replaced:?}"
        );
        before = stage
            .until("they are given out", |state| state.done > lost.done)
            .repeated;
    }
    let end = stage.end();
    assert_eq!((end.done, end.lost), (300, 2));
    // of each two in its slots and two that waited
    assert!(end.repeated <= 8, "{end:?}");
    drop((victims, stays));
}

/// Checks that workers on a machine with four busy programs per core are slow but not declared lost, over
/// more than twice the time after which a silent worker counts as lost.
#[test]
fn nobody_is_taken_for_lost_on_a_busy_machine() {
    let _alone = BUSY.write().unwrap_or_else(PoisonError::into_inner);
    let Some(mut stage) = Testbed::set(900, 20) else {
        return;
    };
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let busy: Vec<Process> = (0..4 * cores)
        .map(|_| {
            let mut command = Command::new("sh");
            command.args(["-c", "while :; do :; done"]);
            Process::start(command)
        })
        .collect();
    let workers = ["worker-01", "worker-02"].map(|name| stage.worker(name, PORT, 1));
    let both = stage.until("both work", |state| state.workers == 2);
    let last = stage.until("nearly all is done", |state| state.done > 880);
    let programs = workers.iter().chain([&stage.coordinator]);
    let shares: Vec<f64> = programs.map(|program| wait_ratio(program.pid())).collect();
    let end = stage.end();
    eprintln!("{end:?}; time without a processor over time with one: {shares:.1?}");
    assert_eq!((end.done, end.lost), (900, 0));
    let together = last.ms - both.ms;
    assert!(together > 2 * SILENCE_MS, "over after {together} ms");
    // who has to wait for the processor, though it sleeps most of the time, is on a busy machine
    let waited = |share: &f64| share.is_nan() || *share > 0.5;
    assert!(shares.iter().all(waited), "{shares:?}");
    for mut process in busy.into_iter().chain(workers) {
        process.signal(Signal::KILL);
        process.wait(LIMIT);
    }
}
