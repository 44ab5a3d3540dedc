//! Counts of a job's failures, and the decision whether the job is retried.
use super::policy::Policy;
use protocol::job::Failure;

/// Number of failures of a job, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Failures {
    /// Number of attempts that exceeded their deadline.
    pub(super) deadlines: u32,
    /// Number of attempts that crashed.
    pub(super) crashes: u32,
    /// Number of workers lost while running the job.
    pub(super) losses: u32,
}

impl Failures {
    /// Counts a failure; returns whether the job is to be tried again.
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
            Failure::Lost { .. } => {
                self.losses += 1;
                self.losses < policy.give_up_after_losses
            }
            Failure::Refused { .. } => true,
            Failure::Misconfigured { .. } => false,
        }
    }

    /// Returns whether so many workers were lost while running the job that it must run alone.
    pub(super) const fn is_suspect(self, policy: &Policy) -> bool {
        self.losses >= policy.alone_after_losses
    }
}
