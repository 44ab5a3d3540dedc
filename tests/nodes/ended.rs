//! Tests of how a run ends the workers that it launched: those alone, and without waiting for a host that hangs.
use super::{resumed::make_case, *};
use rustix::process::Signal;
use std::time::Duration;
use tests::process::{Process, is_alive, wait_until};

const LIMIT: Duration = Duration::from_mins(3);

/// Returns the command of a calibration on one host, whose folder is `run`.
fn search(site: &Site, points: u32, host: &str) -> Command {
    let words = format!(
        "calibrate case --preset random --set points={points} --seed 5 --output json --workers 0 --run run \
         --listen {} --tls keys --advertise 127.0.0.1 --ssh {host}",
        site.locator
    );
    site.command(&words.split(' ').collect::<Vec<&str>>())
}

/// Checks that a command that cannot begin, because the same command is running, ends no worker. Regression: it ended
/// those of the command that was running.
#[test]
fn the_same_command_typed_twice_leaves_the_workers_of_the_first() {
    let site = Site::new(1);
    make_case(&site);
    let mut first = Process::logged(search(&site, 150, "a"), &site.path("first.log"));
    let begun = || {
        let listed = site.horsehead(&["workers", "list", "--run", "run", "--output", "json"]);
        let object: Value = serde_json::from_slice(&listed.stdout).unwrap_or_default();
        object["workers"][0]["done"].as_u64() > Some(3)
    };
    wait_until("the worker has results", LIMIT, begun);
    let worker = site.process("a", "worker-01");
    let second = search(&site, 150, "a").output().unwrap();
    assert!(!second.status.success());
    assert!(errors(&second).contains("in use"), "{}", errors(&second));
    assert!(runs(&worker), "the worker of the first command has ended");
    let status = first.wait(LIMIT);
    let log = fs::read_to_string(site.path("first.log")).unwrap();
    assert_eq!(status, Some(0), "{log}");
    wait_until("the worker has ended", LIMIT, || !runs(&worker));
}

/// Checks that the result is written before the workers are ended, and that an interrupt ends the wait for a host that
/// hangs. Regression: the command did not end, its result was not written, and interrupts had no effect.
#[test]
fn a_host_that_hangs_at_the_end_costs_no_result_and_an_interrupt_leaves_it() {
    let site = Site::new(1);
    make_case(&site);
    let mut command = Process::logged(search(&site, 20, "hanging"), &site.path("log"));
    let result = site.path("run/result.json");
    wait_until("the result is written", LIMIT, || result.exists());
    let worker = site.process("hanging", "worker-01");
    std::thread::sleep(Duration::from_secs(1));
    assert!(is_alive(command.pid()), "it waits");
    command.signal(Signal::TERM);
    let status = command.wait(Duration::from_secs(10));
    let log = fs::read_to_string(site.path("log")).unwrap();
    assert_eq!(status, Some(0), "{log}");
    assert!(log.contains("end by themselves after"), "{log}");
    let mut kill = Command::new("kill");
    kill.args(["-9", &worker]).status().unwrap();
}
