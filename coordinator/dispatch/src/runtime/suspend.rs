//! Detection of system suspend: the clock of a run stands still during suspend, but remote connections time
//! out.
use std::time::Duration;

/// Detector of system suspend.
#[derive(Debug)]
pub(super) struct SuspendDetector {
    /// Upper bound of the time suspended since boot, at the last query.
    known: Duration,
}

impl SuspendDetector {
    /// Creates a detector that counts suspends from now on.
    pub(super) fn since_now() -> Self {
        Self { known: asleep().1 }
    }

    /// Returns a lower bound of the time suspended since the last query.
    pub(super) fn since_last(&mut self) -> Duration {
        self.note(asleep())
    }

    fn note(&mut self, (least, most): (Duration, Duration)) -> Duration {
        let slept = least.saturating_sub(self.known);
        self.known = most;
        slept
    }
}

/// Returns lower and upper bounds of the time suspended since boot; the bounds differ because reading two
/// clocks takes time.
#[cfg(target_os = "linux")]
fn asleep() -> (Duration, Duration) {
    use rustix::time::{ClockId, clock_gettime};
    let read = |clock| Duration::try_from(clock_gettime(clock)).unwrap_or_default();
    let before = read(ClockId::Monotonic);
    let all = read(ClockId::Boottime);
    let after = read(ClockId::Monotonic);
    (all.saturating_sub(after), all.saturating_sub(before))
}

/// Returns zero: on other systems the clock of a run continues during suspend, or the time suspended is
/// unknown.
#[cfg(not(target_os = "linux"))]
fn asleep() -> (Duration, Duration) {
    (Duration::ZERO, Duration::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that no suspend is reported while the machine is awake, however busy it is.
    #[test]
    fn a_machine_that_is_awake_has_not_slept() {
        let mut sleep = SuspendDetector::since_now();
        for _ in 0..100_000 {
            assert_eq!(sleep.since_last(), Duration::ZERO);
        }
    }

    #[test]
    fn what_was_slept_since_the_last_question_is_told_once() {
        let mut sleep = SuspendDetector::since_now();
        let (hour, moment) = (Duration::from_hours(1), Duration::from_millis(3));
        let woken = sleep.known + hour;
        assert_eq!(sleep.note((woken, woken + moment)), hour);
        assert_eq!(sleep.note((woken, woken + moment)), Duration::ZERO);
    }
}
