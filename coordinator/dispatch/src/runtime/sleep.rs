//! Whether the machine slept: the clock of a run stands still meanwhile, the connections of others
//! do not.
use std::time::Duration;

/// Since when the machine may have slept.
#[derive(Debug)]
pub(super) struct Sleep {
    /// Time for which it had slept, at most, when that was last asked.
    known: Duration,
}

impl Sleep {
    /// From now on.
    pub(super) fn since_now() -> Self {
        Self { known: asleep().1 }
    }

    /// For how long it has slept at least since this was last asked.
    pub(super) fn since_last(&mut self) -> Duration {
        self.note(asleep())
    }

    fn note(&mut self, (least, most): (Duration, Duration)) -> Duration {
        let slept = least.saturating_sub(self.known);
        self.known = most;
        slept
    }
}

/// Time for which the machine has slept since it was switched on, at least and at most: reading two
/// clocks takes a moment.
#[cfg(target_os = "linux")]
fn asleep() -> (Duration, Duration) {
    use rustix::time::{ClockId, clock_gettime};
    let read = |clock| Duration::try_from(clock_gettime(clock)).unwrap_or_default();
    let before = read(ClockId::Monotonic);
    let all = read(ClockId::Boottime);
    let after = read(ClockId::Monotonic);
    (all.saturating_sub(after), all.saturating_sub(before))
}

/// Elsewhere the clock of a run goes on in sleep, or nobody knows.
#[cfg(not(target_os = "linux"))]
fn asleep() -> (Duration, Duration) {
    (Duration::ZERO, Duration::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However busy the machine is, time awake is no sleep.
    #[test]
    fn a_machine_that_is_awake_has_not_slept() {
        let mut sleep = Sleep::since_now();
        for _ in 0..100_000 {
            assert_eq!(sleep.since_last(), Duration::ZERO);
        }
    }

    #[test]
    fn what_was_slept_since_the_last_question_is_told_once() {
        let mut sleep = Sleep::since_now();
        let (hour, moment) = (Duration::from_hours(1), Duration::from_millis(3));
        let woken = sleep.known + hour;
        assert_eq!(sleep.note((woken, woken + moment)), hour);
        assert_eq!(sleep.note((woken, woken + moment)), Duration::ZERO);
    }
}
