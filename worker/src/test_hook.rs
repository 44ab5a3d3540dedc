//! Misbehaving jobs, on the worker's side only, for tests of the cluster's fault tolerance.
//!
//! `HORSEHEAD_TEST_MISBEHAVE=17:hang,18:abort` makes the jobs that do nothing and whose payload begins with
//! the number 17 or 18 (64 bits, little endian) behave that way, in slots of the worker that has the
//! variable. `HORSEHEAD_TEST_TRACE=FILE` makes slots append a line to a file for each such job they begin. No
//! message can trigger either.
//!
//! The hook is part of the product because the tests examine the program that is shipped: how its keeper, its
//! pipes and its parent-death signal handle a slot that hangs, aborts or kills its worker. A separate test
//! program would prove this only of itself. Without the variables the hook costs a look at the payload of
//! jobs that do nothing.
use protocol::job::Job;
use rustix::process::{Signal, getppid, kill_process};
use std::{env, fs::OpenOptions, io::Write, process::Command, thread, time::Duration};

/// Environment variable that assigns misbehaviours (hang, abort ...) to numbers of jobs that do nothing.
const MISBEHAVE: &str = "HORSEHEAD_TEST_MISBEHAVE";
/// Environment variable with the file to which slots append a line for each job they begin.
const TRACE: &str = "HORSEHEAD_TEST_TRACE";
/// Duration longer than any job's deadline, used for a job that hangs.
const FOR_EVER: Duration = Duration::from_hours(24 * 365);

/// Applies the misbehaviour configured for a job, if any; to be called before the job is evaluated.
pub(crate) fn before(job: &Job) {
    let Job::Nothing { payload, .. } = job else {
        return;
    };
    let Some(number) = payload
        .first_chunk()
        .map(|bytes| u64::from_le_bytes(*bytes))
    else {
        return;
    };
    if let Some(path) = env::var_os(TRACE) {
        let file = OpenOptions::new().append(true).create(true).open(path);
        let noted = file.and_then(|mut file| file.write_all(format!("{number}\n").as_bytes()));
        if let Err(error) = noted {
            tracing::error!(%error, "the trace cannot be written");
        }
    }
    let list = env::var(MISBEHAVE).unwrap_or_default();
    let behaviour = list
        .split(',')
        .filter_map(|entry| entry.split_once(':'))
        .find(|(job, _)| job.parse() == Ok(number));
    if let Some((_, behaviour)) = behaviour {
        misbehave(behaviour);
    }
}

fn misbehave(behaviour: &str) {
    match behaviour {
        "abort" => std::process::abort(),
        "hang" => thread::sleep(FOR_EVER),
        // does not even sleep: it takes all the processor it can get
        "spin" => burn(FOR_EVER),
        "allocate" => {
            // twice as much each time: no machine has room for long
            let mut held = vec![1_u8; 1 << 20];
            for _ in 0..40 {
                held.extend_from_within(..);
                std::hint::black_box(&held);
            }
        }
        // computes for a tenth of a second, as a thread that has the processor for itself would
        "burn" => burn(Duration::from_millis(100)),
        // a process that leaves the slot's group and session, then an endless job
        "orphan" => {
            let started = Command::new("setsid").args(["sleep", "1000"]).spawn();
            if let Err(error) = started {
                tracing::error!(%error, "no orphan can be started");
            }
            misbehave("hang");
        }
        "kill-worker" => {
            if let Some(worker) = getppid() {
                // the slot follows its worker
                drop(kill_process(worker, Signal::KILL).map_err(std::io::Error::from));
            }
            misbehave("hang");
        }
        other => tracing::error!("{MISBEHAVE} has no behaviour {other}"),
    }
}

fn burn(time: Duration) {
    let until = computed().saturating_add(time);
    while computed() < until {
        std::hint::spin_loop();
    }
}

/// Returns the processor time that this thread has used so far.
fn computed() -> Duration {
    let said = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanos = said
        .split_whitespace()
        .next()
        .and_then(|word| word.parse().ok());
    // where the system does not say, nothing is burnt
    nanos.map_or(Duration::MAX, Duration::from_nanos)
}
