//! Thread that supplies one slot with jobs and enforces their deadlines.
//!
//! Time for which the slot's process was ready but got no processor does not count towards the deadline:
//! otherwise jobs would be given up on a busy machine, and the result of a run would depend on the load of
//! the machine.
use super::child::Child;
use super::task::{Freed, SlotOptions, Task};
use protocol::{
    job::{Failure, Outcome},
    message::{Attempt, Cost, FromSlot},
};
use std::{
    sync::mpsc::{Receiver, RecvTimeoutError, Sender},
    time::{Duration, Instant},
};
use tokio::sync::mpsc::UnboundedSender;

/// Interval at which a keeper thread shows that it is responsive.
const PULSE: Duration = Duration::from_millis(500);
/// Shortest pause before the keeper checks again a job that is past its deadline but waited for a processor.
const MIN_RECHECK: Duration = Duration::from_millis(20);

#[derive(Debug)]
pub(super) enum ToKeeper {
    Run(Task),
    Cancel(Attempt),
    /// Message of the slot process with the given number, or `None` when that process's output ended.
    FromProcess(u64, Option<FromSlot>),
    End,
}

#[derive(Debug)]
pub(super) struct Keeper {
    slot: usize,
    options: SlotOptions,
    to_self: Sender<ToKeeper>,
    freed: UnboundedSender<Freed>,
    child: Option<Child>,
    /// Number of the current slot process, by which a late message of an ended process is told from one of
    /// its successor.
    number: u64,
    current: Option<Current>,
}

#[derive(Clone, Copy, Debug)]
struct Current {
    attempt: Attempt,
    begun: Instant,
    deadline: Duration,
    /// Time for which the slot's process had waited for a processor before this job.
    waited: Duration,
    /// Processor time that the slot process had used when the job was last checked after its deadline; `None`
    /// before the first check.
    seen: Option<Duration>,
}

impl Keeper {
    pub(super) const fn new(
        slot: usize,
        options: SlotOptions,
        to_self: Sender<ToKeeper>,
        freed: UnboundedSender<Freed>,
    ) -> Self {
        Self {
            slot,
            options,
            to_self,
            freed,
            child: None,
            number: 0,
            current: None,
        }
    }

    pub(super) fn keep(&mut self, messages: &Receiver<ToKeeper>, pulse: impl Fn()) {
        loop {
            pulse();
            match messages.recv_timeout(self.patience()) {
                Ok(ToKeeper::Run(task)) => self.begin(task),
                Ok(ToKeeper::Cancel(attempt)) => self.cancel(attempt),
                Ok(ToKeeper::FromProcess(number, message)) if number == self.number => {
                    self.on_message(message);
                }
                Ok(ToKeeper::FromProcess(..)) | Err(RecvTimeoutError::Timeout) => {}
                Ok(ToKeeper::End) | Err(RecvTimeoutError::Disconnected) => {
                    self.child = None;
                    return;
                }
            }
            self.check_deadline();
        }
    }

    fn patience(&self) -> Duration {
        self.current.map_or(PULSE, |current| {
            let left = current.deadline.saturating_sub(current.begun.elapsed());
            left.clamp(MIN_RECHECK, PULSE)
        })
    }

    /// Returns whether the current job has used up its time. The system does not count a wait that is still
    /// going on, so a process that is ready and got no processor time since the last check is not overdue.
    fn is_overdue(&mut self) -> bool {
        let Some(current) = &mut self.current else {
            return false;
        };
        let elapsed = current.begun.elapsed();
        if elapsed < current.deadline {
            return false;
        }
        let look = self
            .child
            .as_ref()
            .map(Child::processor_usage)
            .unwrap_or_default();
        let waited = look.waited.saturating_sub(current.waited);
        let before = current.seen.replace(look.computed);
        let waits = look.is_ready && before.is_none_or(|before| before == look.computed);
        !waits && elapsed.saturating_sub(waited) >= current.deadline
    }

    fn begin(&mut self, task: Task) {
        let Task {
            attempt,
            deadline,
            job,
            case,
        } = task;
        self.current = Some(Current {
            attempt,
            begun: Instant::now(),
            deadline,
            waited: self
                .child
                .as_ref()
                .map_or(Duration::ZERO, |it| it.processor_usage().waited),
            seen: None,
        });
        let started = self.start_if_needed();
        let given = started.and_then(|()| match &mut self.child {
            Some(child) => child.run(job, case.as_ref()),
            None => Ok(()),
        });
        if let Err(error) = given {
            let end = self.child.take().map_or_else(String::new, Child::ended);
            let how = format!("the slot's process does not accept the job: {error}; it {end}");
            self.finish(Some(Outcome::Failed(Failure::crashed(how))), 0);
        }
    }

    fn start_if_needed(&mut self) -> std::io::Result<()> {
        if self.child.is_none() {
            self.number += 1;
            let (number, to_self) = (self.number, self.to_self.clone());
            let child = Child::start(&self.options, move |message| {
                // a keeper that has ended needs no news
                drop(to_self.send(ToKeeper::FromProcess(number, message)));
            });
            self.child = Some(child?);
        }
        Ok(())
    }

    fn cancel(&mut self, attempt: Attempt) {
        if self
            .current
            .is_some_and(|current| current.attempt == attempt)
        {
            self.child = None;
            self.finish(None, 0);
        }
    }

    fn on_message(&mut self, message: Option<FromSlot>) {
        match message {
            Some(FromSlot::Ready) => {}
            Some(FromSlot::Done { outcome, cpu_us }) => self.finish(Some(*outcome), cpu_us),
            None => {
                let end = self.child.take().map_or_else(String::new, Child::ended);
                let how = format!("the process that computed the job {end}");
                self.finish(Some(Outcome::Failed(Failure::crashed(how))), 0);
            }
        }
    }

    fn check_deadline(&mut self) {
        let overdue = self.is_overdue().then_some(self.current).flatten();
        if let Some(current) = overdue {
            self.child = None;
            let limit_ms = u64::try_from(current.deadline.as_millis()).unwrap_or(u64::MAX);
            self.finish(Some(Outcome::Failed(Failure::deadline(limit_ms))), 0);
        }
    }

    fn finish(&mut self, outcome: Option<Outcome>, cpu_us: u64) {
        let Some(current) = self.current.take() else {
            return;
        };
        let wall_us = u64::try_from(current.begun.elapsed().as_micros()).unwrap_or(u64::MAX);
        let freed = Freed {
            slot: self.slot,
            attempt: current.attempt,
            cost: Cost { wall_us, cpu_us },
            outcome,
        };
        // a session that has ended needs no results
        drop(self.freed.send(freed));
    }
}
