//! What the system says that this process has used.
use rustix::time::{ClockId, clock_gettime};
use std::{fs, time::Duration};

/// Name of the thread of sessions, whose processor time is not the coordinator's.
pub(super) const SESSIONS: &str = "bench-sessions";

/// Processor time of this process so far, threads that have ended included.
pub fn processor_time() -> Duration {
    let now = clock_gettime(ClockId::ProcessCPUTime);
    Duration::try_from(now).unwrap_or_default()
}

/// Processor time of the coordinator: of the living threads of this process, but those of sessions.
pub(super) fn cost() -> Duration {
    cpu_time(|thread| thread != SESSIONS)
}

/// Processor time of the living threads of this process that are counted, by name; zero where the
/// system does not say.
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

/// Memory of this process; not a number where the system does not say.
pub(super) fn resident_mib() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kib.unwrap_or(f64::NAN) / 1024.0
}
