//! A disk that is really full: a small file system of its own.
//!
//! It is mounted in a mount namespace, which only the test's own processes see. Where the machine
//! does not allow that, the test says so and proves nothing; the writer's own tests inject the same
//! failures.
use std::{
    fs,
    io::{BufRead, BufReader, Read},
    path::Path,
    process::{Command, Stdio},
    sync::{
        Arc, Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
    time::Duration,
};
use tests::process::{Process, free_locator, wait_until};

const LIMIT: Duration = Duration::from_mins(1);
const JOBS: u64 = 400;

/// Mounts 200 KiB at `$0`, fills most of it, then becomes the program that follows.
const MOUNT: &str = "mount -t tmpfs -o size=200k tmpfs \"$0\" && \
                     head -c 140000 /dev/zero > \"$0/ballast\" && exec \"$@\"";

fn may_mount(folder: &Path) -> bool {
    let tried = Command::new("unshare")
        .args(["--user", "--map-root-user", "--mount", "sh", "-c", MOUNT])
        .arg(folder)
        .arg("true")
        .stderr(Stdio::null())
        .status();
    tried.is_ok_and(|status| status.success())
}

#[test]
fn a_full_disk_pauses_the_run_and_room_lets_it_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let small = folder.path().join("small");
    fs::create_dir(&small).unwrap();
    if !may_mount(&small) {
        eprintln!("skipped: this machine lets nobody mount a file system in a namespace");
        return;
    }
    let locator = free_locator();
    let _worker = Process::worker(&locator, &["--slots", "2"]);
    let mut command = Command::new("unshare");
    command
        .args(["--user", "--map-root-user", "--mount", "sh", "-c", MOUNT])
        .arg(&small)
        .arg(env!("CARGO_BIN_EXE_test-coordinator"))
        .arg(small.join("run"))
        .args([&locator, &JOBS.to_string(), "0", "0"])
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
            heard
                .lock()
                .unwrap()
                .push_str(&String::from_utf8_lossy(&part[..length]));
        }
    });
    let says = |what: &str| said.lock().unwrap().contains(what);
    wait_until("it says that it pauses", LIMIT, || says("the run pauses"));
    thread::sleep(Duration::from_secs(1));
    let paused = results.load(Ordering::Relaxed);
    thread::sleep(Duration::from_millis(1500));
    assert_eq!(
        results.load(Ordering::Relaxed),
        paused,
        "nothing goes on meanwhile"
    );
    assert!((paused as u64) < JOBS, "the disk was too large: {paused}");
    // room, seen from outside of the namespace
    let inside = format!(
        "/proc/{}/root{}",
        process.pid().as_raw_nonzero(),
        small.display()
    );
    fs::remove_file(Path::new(&inside).join("ballast")).unwrap();
    wait_until("it goes on", LIMIT, || says("the run goes on"));
    wait_until("it is done", LIMIT, || {
        results.load(Ordering::Relaxed) as u64 > JOBS
    });
    let last = reader.join().unwrap();
    assert!(last.starts_with("done repeated 0 "), "{last}");
    assert_eq!(process.wait(LIMIT), Some(0));
    listener.join().unwrap();
    eprintln!("paused after {paused} of {JOBS} results");
}
