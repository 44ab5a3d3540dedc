//! Tests with a disk that is really full: a small file system of the test's own.
//!
//! The file system is mounted in a mount namespace, visible only to the test's own processes. Where the
//! machine does not allow that, the test reports it and is skipped; the journal writer's own tests inject the
//! same failures.
use super::LIMIT;
use journal::event::Event;
use std::{
    fs,
    io::{BufRead, BufReader, Read, Write},
    path::{Path, PathBuf},
    process::{Command, Stdio},
    sync::{
        Arc, Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread::{self, JoinHandle},
    time::Duration,
};
use tests::process::{Process, free_locator, is_alive, wait_until};

const JOBS: u64 = 400;
const NO_MOUNT: &str = "this machine lets nobody mount a file system in a namespace";

/// Shell script that mounts 200 KiB at `$0`, fills most of it and runs the program that follows. The run
/// folder is copied next to the mount point, since the disk vanishes with its processes.
const MOUNT: &str = "mount -t tmpfs -o size=200k tmpfs \"$0\" && \
                     head -c 140000 /dev/zero > \"$0/ballast\" && \"$@\" && \
                     if [ -d \"$0/run\" ]; then cp -r \"$0/run\" \"$0/../copy\"; fi";

fn may_mount(folder: &Path) -> bool {
    let tried = Command::new("unshare")
        .args(["--user", "--map-root-user", "--mount", "sh", "-c", MOUNT])
        .arg(folder)
        .arg("true")
        .stderr(Stdio::null())
        .status();
    tried.is_ok_and(|status| status.success())
}

/// Coordinator whose run folder lies on a small disk, with its captured output.
struct OnSmallDisk {
    process: Process,
    /// Path of the small file system as seen from outside its mount namespace.
    disk: PathBuf,
    results: Arc<AtomicUsize>,
    said: Arc<Mutex<String>>,
    reader: JoinHandle<String>,
    listener: JoinHandle<()>,
}

impl OnSmallDisk {
    /// Starts a coordinator with a number of jobs on a small disk; `None` if the machine does not allow such
    /// mounts. When the coordinator has ended, its run folder is copied to `copy` in `folder`.
    fn start(folder: &Path, locator: &str, jobs: u64, delay_ms: u32) -> Option<Self> {
        Self::start_with(folder, locator, (jobs, delay_ms), &[])
    }

    /// Starts a coordinator as [`Self::start`] does, with additional environment variables.
    fn start_with(
        folder: &Path,
        locator: &str,
        (jobs, delay_ms): (u64, u32),
        environment: &[(&str, &str)],
    ) -> Option<Self> {
        let small = folder.join("small");
        fs::create_dir(&small).unwrap();
        if !may_mount(&small) {
            return None;
        }
        let mut command = Command::new("unshare");
        command
            .args(["--user", "--map-root-user", "--mount", "sh", "-c", MOUNT])
            .arg(&small)
            .arg(env!("CARGO_BIN_EXE_test-coordinator"))
            .arg(small.join("run"))
            .args([locator, &jobs.to_string(), &delay_ms.to_string(), "0"])
            .envs(environment.iter().copied())
            .stderr(Stdio::piped());
        let mut process = Process::start(command);
        let results = Arc::new(AtomicUsize::new(0));
        let (counted, output) = (Arc::clone(&results), process.output());
        let reader = thread::spawn(move || {
            let mut last = String::new();
            for line in BufReader::new(output).lines().map_while(Result::ok) {
                counted.fetch_add(1, Ordering::Relaxed);
                last = line;
            }
            last
        });
        let said = Arc::new(Mutex::new(String::new()));
        let (heard, mut errors) = (Arc::clone(&said), process.errors());
        let listener = thread::spawn(move || {
            let mut part = [0; 4096];
            while let Ok(length @ 1..) = errors.read(&mut part) {
                let words = String::from_utf8_lossy(&part[..length]).into_owned();
                heard.lock().unwrap().push_str(&words);
            }
        });
        let pid = process.pid().as_raw_nonzero();
        Some(Self {
            disk: PathBuf::from(format!("/proc/{pid}/root{}", small.display())),
            process,
            results,
            said,
            reader,
            listener,
        })
    }

    fn says(&self, what: &str) -> bool {
        self.said.lock().unwrap().contains(what)
    }

    fn results(&self) -> u64 {
        self.results.load(Ordering::Relaxed) as u64
    }

    fn make_room(&self) {
        fs::remove_file(self.disk.join("ballast")).unwrap();
    }

    /// Waits until the coordinator exits with code 0 and returns its last line.
    fn end(mut self) -> String {
        let last = self.reader.join().unwrap();
        assert_eq!(self.process.wait(LIMIT), Some(0));
        self.listener.join().unwrap();
        last
    }
}

#[test]
fn a_full_disk_pauses_the_run_and_room_lets_it_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    let _worker = Process::worker(&locator, &["--slots", "2"]);
    let Some(run) = OnSmallDisk::start(folder.path(), &locator, JOBS, 0) else {
        tests::skip(NO_MOUNT);
        return;
    };
    wait_until("it says that it pauses", LIMIT, || {
        run.says("the run is paused")
    });
    thread::sleep(Duration::from_secs(1));
    let paused = run.results();
    thread::sleep(Duration::from_millis(1500));
    assert_eq!(run.results(), paused, "nothing goes on meanwhile");
    assert!(paused < JOBS, "the disk was too large: {paused}");
    run.make_room();
    wait_until("it goes on", LIMIT, || run.says("the run continues"));
    wait_until("it is done", LIMIT, || run.results() > JOBS);
    let last = run.end();
    assert!(last.starts_with("done repeated 0 "), "{last}");
    eprintln!("paused after {paused} of {JOBS} results");
}

/// Checks that a run on a full disk does not wait for ever: after the limit it reports the cause and exits
/// with code 1.
#[test]
fn a_pause_that_is_too_long_ends_the_run_with_what_it_has() {
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    let _worker = Process::worker(&locator, &["--slots", "2"]);
    let limit = [("HORSEHEAD_TEST_PAUSE_LIMIT_S", "2")];
    let Some(mut run) = OnSmallDisk::start_with(folder.path(), &locator, (JOBS, 0), &limit) else {
        tests::skip(NO_MOUNT);
        return;
    };
    wait_until("it says that it pauses", LIMIT, || {
        run.says("After 2 s it ends")
    });
    let results = run.results();
    assert!((1..JOBS).contains(&results), "{results}");
    assert_eq!(run.process.wait(LIMIT), Some(1));
    run.listener.join().unwrap();
    let said = run.said.lock().unwrap().clone();
    let words = "the journal could not be written for 2 s (";
    assert!(
        said.contains(words) && said.contains("repeat the command to continue"),
        "{said}"
    );
}

/// Checks that a run that ends on a full disk waits for space, since workers discard their results when a run
/// ends. Regression: a coordinator waited a second for a full disk, told its workers that the run was over,
/// and exited without its last results.
#[test]
fn a_run_that_ends_on_a_full_disk_waits_for_room() {
    const SLOTS: u64 = 20;
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    let trace = folder.path().join("trace");
    let path = trace.display().to_string();
    let environment = [("HORSEHEAD_TEST_TRACE", path.as_str())];
    let slots = SLOTS.to_string();
    let _worker = Process::worker_with(&locator, &["--slots", &slots], &environment);
    // each slot has one and another waits: all are given out before the first is done
    let Some(run) = OnSmallDisk::start(folder.path(), &locator, 2 * SLOTS, 6000) else {
        tests::skip(NO_MOUNT);
        return;
    };
    wait_until("the first jobs are begun", LIMIT, || trace.is_file());
    // to the last byte; what the journal has of its last block holds some results and not all
    let mut filler = fs::File::create(run.disk.join("filler")).unwrap();
    while filler.write_all(&[0; 512]).is_ok() {}
    wait_until("it comes to its end", LIMIT, || {
        run.says("the run ends once its last")
    });
    // what it says of results and what it says of the disk come by two pipes
    wait_until("all results are there", LIMIT, || {
        run.results() == 2 * SLOTS
    });
    thread::sleep(Duration::from_secs(3));
    assert!(is_alive(run.process.pid()), "it left without its results");
    run.make_room();
    let last = run.end();
    assert!(last.starts_with("done repeated 0 "), "{last}");
    let mut stored = 0;
    journal::fold(
        &folder.path().join("copy").join(journal::FILE),
        |_, event| {
            stored += u64::from(matches!(event, Event::Finished(_)));
        },
    )
    .unwrap();
    assert_eq!(stored, 2 * SLOTS);
}
