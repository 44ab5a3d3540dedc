//! Scheduler core together with the division of jobs into parts: all that a coordinator decides, without link, journal
//! and clock. The simulation of a cluster runs the same code.
//!
//! Parts do not leave this module: commands concern the jobs that were submitted.
use super::divide::{Divide, DividedJobs, PartResult, is_not_stored, part_count};
use crate::scheduler::{Command, Completed, Core, Input, Notice, StopReason};
use journal::event::Finished;
use journal::job_range::is_part;
use protocol::{
    id::JobId,
    job::{Job, Outcome},
};
use std::{sync::Arc, time::Duration};

/// Scheduler core and divided jobs of one coordinator process.
#[derive(Debug)]
pub(crate) struct Coordination {
    core: Core,
    divided: DividedJobs,
    commands: Vec<Command>,
}

impl Coordination {
    /// Creates the state of a coordinator process from its scheduler core; `divide` divides its jobs.
    pub(crate) const fn new(core: Core, divide: Arc<dyn Divide>) -> Self {
        Self {
            core,
            divided: DividedJobs::new(divide),
            commands: Vec::new(),
        }
    }

    /// Returns the scheduler core.
    pub(crate) const fn core(&self) -> &Core {
        &self.core
    }

    /// Returns whether a submitted job is being computed in several parts.
    #[cfg(test)]
    pub(crate) fn has_parts(&self) -> bool {
        self.divided.has_parts()
    }

    /// Returns the scheduler core for changes of its options by a test.
    #[cfg(test)]
    pub(crate) const fn core_mut(&mut self) -> &mut Core {
        &mut self.core
    }

    /// Returns the id under which a job was submitted: that of the whole job for a part.
    pub(crate) fn submitted_id(&self, job: JobId) -> JobId {
        self.divided.submitted_id(job)
    }

    /// Handles an input at time `now`; returns the commands that the caller must execute, in order.
    pub(crate) fn handle(&mut self, input: Input, now: Duration) -> Vec<Command> {
        self.process(input, now);
        std::mem::take(&mut self.commands)
    }

    /// Submits jobs that have no result yet: an anticipated one with the same content is claimed, and divisible jobs
    /// are divided into as many parts as there are idle slots for them.
    pub(crate) fn submit(&mut self, jobs: Vec<(JobId, Job)>, now: Duration) -> Vec<Command> {
        let mut new = jobs;
        new.retain(|(id, job)| !self.claim(*id, job, now));
        let (divisible, plain): (Vec<_>, Vec<_>) = new
            .into_iter()
            .partition(|(_, job)| self.divided.units(job) > 1);
        for (id, job) in plain {
            self.process(Input::Submit { id, job }, now);
        }
        let (count, idle) = (divisible.len(), self.core.idle_slots());
        for (id, job) in divisible {
            let parts = part_count(self.divided.units(&job), count, idle);
            let parts = self.divided.divide(id, job, parts);
            for (id, job) in parts {
                self.process(Input::Submit { id, job }, now);
            }
        }
        std::mem::take(&mut self.commands)
    }

    /// Replaces the anticipated jobs, likeliest first, which idle slots compute ahead.
    pub(crate) fn anticipate(&mut self, jobs: Vec<Job>, now: Duration) -> Vec<Command> {
        let change = self.divided.anticipate(jobs, self.core.idle_slots());
        if !change.withdrawn.is_empty() {
            let jobs = change.withdrawn;
            self.process(Input::Withdraw { jobs }, now);
        }
        for (id, job) in change.parts {
            self.process(Input::Anticipate { id, job }, now);
        }
        std::mem::take(&mut self.commands)
    }

    /// Makes a submitted job of an anticipated one with the same content; returns whether there is one.
    fn claim(&mut self, id: JobId, job: &Job, now: Duration) -> bool {
        let Some(jobs) = self.divided.claim(id, job) else {
            return false;
        };
        self.process(Input::Claim { jobs }, now);
        let result = self.divided.join_finished(id);
        self.take_joined(result);
        true
    }

    fn process(&mut self, input: Input, now: Duration) {
        let input = if let Input::Stored { jobs } = input {
            let jobs = self.divided.stored(jobs);
            Input::Stored { jobs }
        } else {
            input
        };
        for command in self.core.handle(input, now) {
            match command {
                Command::Store(result) if is_part(result.job()) => self.finish_part(*result, now),
                Command::Deliver(part) if is_part(part.id) => self.deliver_part(&part),
                Command::Notice(notice) => {
                    let notice = self.of_submitted_jobs(notice);
                    self.commands.push(Command::Notice(notice));
                }
                Command::Stop(mut reason) => {
                    if let StopReason::WorkersLost { job, .. } = &mut reason {
                        *job = self.submitted_id(*job);
                    }
                    self.commands.push(Command::Stop(reason));
                }
                other @ (Command::Send { .. }
                | Command::Store(_)
                | Command::Record(_)
                | Command::Deliver(_)) => self.commands.push(other),
            }
        }
    }

    /// Returns a notice with the ids of whole jobs in place of their parts.
    fn of_submitted_jobs(&self, mut notice: Notice) -> Notice {
        match &mut notice {
            Notice::AwaitsWorker { job, .. } | Notice::GivenUp { job, .. } => {
                *job = self.submitted_id(*job);
            }
            Notice::Quarantined { jobs, .. } => {
                for job in &mut *jobs {
                    *job = self.submitted_id(*job);
                }
                jobs.sort_unstable();
                jobs.dedup();
            }
            Notice::Joined { .. }
            | Notice::Left { .. }
            | Notice::Lost { .. }
            | Notice::Refused { .. }
            | Notice::OtherVersion { .. }
            | Notice::NoWorker { .. }
            | Notice::Stalled { .. } => {}
        }
        notice
    }

    /// Takes the result of a part of a divided job; once the job is complete, stores and delivers its result.
    fn finish_part(&mut self, result: Finished, now: Duration) {
        let part = result.job();
        match self.divided.finish(result) {
            PartResult::Discarded => self.process(Input::Stored { jobs: vec![part] }, now),
            joined @ (PartResult::Awaited | PartResult::Joined(_)) => self.take_joined(joined),
        }
    }

    /// Stores and delivers the result of a divided job, if it is complete.
    fn take_joined(&mut self, result: PartResult) {
        if let PartResult::Joined(whole) = result {
            self.commands.push(Command::Deliver(Completed {
                id: whole.job(),
                cost: whole.cost,
                outcome: whole.outcome.clone(),
                replayed: false,
            }));
            self.commands.push(Command::Store(whole));
        }
    }

    /// Delivers the failure of a part that is not stored as that of its job; results that are stored are handled
    /// with their storing.
    fn deliver_part(&mut self, part: &Completed) {
        let not_stored =
            matches!(&part.outcome, Outcome::Failed(failure) if is_not_stored(failure));
        if let Some(failed) = not_stored.then(|| self.divided.fail(part)).flatten() {
            self.commands.push(Command::Deliver(failed));
        }
    }
}
