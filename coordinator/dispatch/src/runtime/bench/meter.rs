//! Processor time and memory of this process, as reported by the operating system.
use rustix::time::{ClockId, clock_gettime};
use std::{fs, time::Duration};

/// Name of the thread that runs simulated sessions; its processor time is not counted as the coordinator's.
pub(super) const SESSIONS: &str = "bench-sessions";

/// Returns the processor time of this process so far, including threads that have ended.
pub fn processor_time() -> Duration {
    let now = clock_gettime(ClockId::ProcessCPUTime);
    Duration::try_from(now).unwrap_or_default()
}

/// Returns the coordinator's processor time: that of this process's living threads except the sessions
/// thread.
pub(super) fn cost() -> Duration {
    cpu_time(|thread| thread != SESSIONS)
}

/// Sums the processor time of this process's living threads whose name satisfies `counts`; zero if the
/// operating system does not report it.
fn cpu_time(counts: impl Fn(&str) -> bool) -> Duration {
    let threads = fs::read_dir("/proc/self/task")
        .into_iter()
        .flatten()
        .flatten();
    let nanos = threads.filter_map(|thread| {
        let name = fs::read_to_string(thread.path().join("comm")).ok()?;
        counts(name.trim_end()).then_some(())?;
        let stat = fs::read_to_string(thread.path().join("schedstat")).ok()?;
        stat.split_whitespace().next()?.parse::<u64>().ok()
    });
    Duration::from_nanos(nanos.sum())
}

/// Returns the resident memory of this process (MiB); NaN if the system does not report it.
pub(super) fn resident_mib() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kib.unwrap_or(f64::NAN) / 1024.0
}
