//! Counts of a job's failures, and the decision whether the job is retried.
use super::policy::Policy;
use protocol::job::Failure;
use std::time::Duration;

/// Number of failures of a job, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Failures {
    /// Number of attempts that exceeded their deadline.
    pub(super) deadlines: u32,
    /// Number of attempts that crashed.
    pub(super) crashes: u32,
    /// Number of workers that were lost while they held the job.
    pub(super) losses: u32,
    /// Time of the last of these losses.
    pub(super) last_loss: Duration,
}

impl Failures {
    /// Counts a failure of an attempt; returns whether the job is to be tried again.
    pub(super) fn count(&mut self, failure: &Failure, policy: &Policy) -> bool {
        match failure {
            Failure::Deadline { .. } => {
                self.deadlines += 1;
                self.deadlines < policy.give_up_after_deadlines
            }
            Failure::Crashed { .. } => {
                self.crashes += 1;
                self.crashes < policy.give_up_after_crashes
            }
            // a worker cannot report its own loss, and a loss is no verdict on the job
            Failure::Refused { .. } | Failure::Lost { .. } => true,
            Failure::Misconfigured { .. } => false,
        }
    }

    /// Counts the loss of a worker that held the job.
    pub(super) const fn count_loss(&mut self, now: Duration) {
        self.losses = self.losses.saturating_add(1);
        self.last_loss = now;
    }

    /// Returns whether so many workers were lost while they held the job that it must run alone.
    pub(super) const fn is_suspect(self, policy: &Policy) -> bool {
        self.losses >= policy.alone_after_losses
    }

    /// Returns whether so many workers were lost while they held the job that it waits for a worker that joins
    /// after the last loss.
    pub(super) const fn awaits_new_worker(self, policy: &Policy) -> bool {
        self.losses >= policy.wait_after_losses
    }
}
