//! Dispatch of the core's inputs to the modules that handle them.
use super::{
    admission, anticipated, assign, drain,
    input::{Command, Input},
    lease, membership, reconcile, result,
    slot_time::WorkState,
    state::{Core, Pending, Phase},
    stragglers,
};
use protocol::{
    id::{JobId, WorkerId},
    job::Job,
    message::{FromWorker, Heartbeat, ToWorker},
};
use std::{mem, time::Duration};

impl Core {
    /// Handles an input to the scheduler core at time `now`, measured from any fixed moment; returns the
    /// commands that the runtime must execute, in order.
    pub fn handle(&mut self, input: Input, now: Duration) -> Vec<Command> {
        self.clocks.advance(now);
        membership::compensate_stall(self, now);
        match input {
            Input::Submit { id, job } => submit(self, id, job, now),
            Input::Anticipate { id, job } => anticipated::anticipate(self, id, job),
            Input::Claim { jobs } => anticipated::claim(self, jobs),
            Input::Withdraw { jobs } => anticipated::withdraw(self, jobs, now),
            Input::Message { from, message } => heard(self, from, message, now),
            Input::OtherRun { from } => self.send(from, ToWorker::Identify),
            Input::OtherVersion { from, version } => {
                admission::other_version(self, from, version);
            }
            Input::Disconnected { worker } => membership::connection_lost(self, worker, now),
            Input::Stored { jobs } => result::stored(self, jobs),
            Input::Suspended { time } => membership::start_reconnect_grace(self, time, now),
            Input::Drain { worker, how } => drain::drain(self, worker, how, now),
            Input::Tick => tick(self, now),
            Input::Finish => self.phase = Phase::Finishing,
            Input::Writable(writable) => self.paused = !writable,
            Input::Close => close(self, now),
        }
        drain::end_drained(self, now);
        if self.may_give_out() && membership::rejoin_finished(self, now) {
            anticipated::make_room(self, self.queued_jobs(), now);
            assign::assign(self, now);
            stragglers::steal(self, now);
            anticipated::assign(self, now);
        }
        self.clocks.set_state(WorkState {
            computes: self.held_jobs() > 0,
            waits_for_others: self.waits_for_others(),
        });
        mem::take(&mut self.commands)
    }
}

fn submit(core: &mut Core, id: JobId, job: Job, now: Duration) {
    if core.has_finished(id) || core.jobs.contains_key(&id) {
        return;
    }
    core.jobs.insert(id, Pending::new(job));
    core.queue.insert(id);
    lease::adopt(core, id, now);
    if let Some((from, done)) = core.unclaimed.take(id) {
        result::done(core, from, done, now);
    }
}

fn heard(core: &mut Core, from: WorkerId, message: FromWorker, now: Duration) {
    let member = core.members.get_mut(&from);
    let known = member.map(|member| member.last_heard = now).is_some();
    match message {
        FromWorker::Announce(_) if core.phase == Phase::Closed => {}
        FromWorker::Announce(announcement) => admission::announce(core, from, *announcement, now),
        FromWorker::Beat(beat) if known => handle_heartbeat(core, from, &beat, now),
        FromWorker::Beat(_) => core.send(from, ToWorker::Identify),
        // it differs from the others, and so may what it computes
        FromWorker::Done(_) if core.refused.contains(&from) => {}
        FromWorker::Done(done) => {
            if !known {
                core.send(from, ToWorker::Identify);
            }
            result::done(core, from, *done, now);
        }
        FromWorker::Leaving { reason } if known => membership::leave(core, from, &reason, now),
        FromWorker::Leaving { .. } => {}
    }
}

fn handle_heartbeat(core: &mut Core, from: WorkerId, beat: &Heartbeat, now: Duration) {
    let Some(ready) = admission::is_ready(core, from, beat) else {
        return;
    };
    if let Some(member) = core.members.get_mut(&from) {
        member.set_ready(ready, &core.clocks);
    }
    reconcile::reconcile(core, from, beat, now);
    if beat.case.is_some() {
        membership::worker_returned(core, from, now);
    }
}

fn tick(core: &mut Core, now: Duration) {
    membership::check_silence(core, now);
    result::check_overdue(core, now);
    membership::check_no_workers(core, now);
    membership::check_waiting_jobs(core, now);
    stragglers::copy_slow(core, now);
    if now.saturating_sub(core.last_account) >= core.options.policy.account_interval {
        core.account(now);
    }
}

fn close(core: &mut Core, now: Duration) {
    let members: Vec<WorkerId> = core.members.keys().copied().collect();
    for to in members {
        core.send(to, ToWorker::Ended);
    }
    core.account(now);
    core.phase = Phase::Closed;
}
