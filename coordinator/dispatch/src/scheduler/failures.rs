//! How often a job has failed, and whether it is tried again.
use super::policy::Policy;
use protocol::job::Failure;

/// How often a job has failed, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Failures {
    /// Overdue attempts.
    pub(super) deadlines: u32,
    /// Crashed attempts.
    pub(super) crashes: u32,
    /// Workers lost over it.
    pub(super) losses: u32,
}

impl Failures {
    /// Counts a failure; `true` if the job is to be tried again.
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

    /// Whether workers were lost over the job so often that it must run alone.
    pub(super) const fn is_suspect(self, policy: &Policy) -> bool {
        self.losses >= policy.alone_after_losses
    }
}
