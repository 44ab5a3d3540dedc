//! Processor time and memory of this process, as reported by the operating system.
use rustix::time::{ClockId, clock_gettime};
use std::{fs, time::Duration};

/// Returns the processor time of this process so far, including threads that have ended.
pub fn processor_time() -> Duration {
    let now = clock_gettime(ClockId::ProcessCPUTime);
    Duration::try_from(now).unwrap_or_default()
}

/// Returns the resident memory of this process (MiB); NaN if the system does not report it.
pub(super) fn resident_mib() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kib.unwrap_or(f64::NAN) / 1024.0
}
