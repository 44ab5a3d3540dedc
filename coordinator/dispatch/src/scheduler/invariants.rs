//! Invariants of the scheduler core that hold after every input, for scenes and for the simulation with faults.
use super::{
    assign::{may_have, reserved},
    member::Member,
    state::Core,
    unclaimed_results::MOST_BYTES,
};
use protocol::id::{JobId, WorkerId};

impl Core {
    /// Checks that every job is queued or held, every lease has a job and every job a place, that no idle worker waits
    /// beside a job that it may have, and that what is kept in memory is bounded.
    ///
    /// # Panics
    /// If an invariant does not hold.
    pub(crate) fn check_invariants(&self) {
        for (id, pending) in &self.jobs {
            let anticipated = self.anticipated.contains(id);
            let queued = if anticipated {
                self.anticipated_queue.contains(id)
            } else {
                self.queue.contains(id)
            };
            let is_waiting = pending.holders.is_empty();
            assert_eq!(queued, is_waiting, "job {id} is queued or held");
            assert!(!self.has_finished(*id), "job {id} is pending or finished");
            let suspect = self.must_run_alone(pending);
            assert_eq!(suspect, self.suspects.contains(id), "job {id} is a suspect");
            for holder in &pending.holders {
                assert!(self.members[holder].holds(*id), "{holder} holds {id}");
            }
        }
        let queued = self.queue.iter().chain(&self.anticipated_queue);
        for job in queued.chain(&self.suspects).chain(&self.anticipated) {
            assert!(self.jobs.contains_key(job), "job {job} is pending");
        }
        for (id, member) in &self.members {
            // as many as it is given, and as many that it reports holding since before it was lost
            let most = 2 * self.options.policy.jobs_per_slot * member.slots();
            assert!(member.leases.len() <= most, "more than {most} outstanding");
            for lease in &member.leases {
                let job = self.jobs.get(&lease.attempt.job);
                let holds = job.is_some_and(|job| job.holders.contains(id));
                assert!(holds, "{id} has a lease of {:?}", lease.attempt);
            }
        }
        self.check_idle();
        let slots: usize = self.members.values().map(Member::slots).sum();
        let most = self.options.policy.most_unstored + self.options.policy.jobs_per_slot * slots;
        assert!(
            self.storing.len() <= most,
            "{} unstored",
            self.storing.len()
        );
        assert!(self.unclaimed.bytes() <= MOST_BYTES);
    }

    /// Checks that no idle worker waits beside a queued job that it may have.
    fn check_idle(&self) {
        if !self.may_give_out() || self.rejoin_until.is_some() || !self.options.expected.is_empty()
        {
            return;
        }
        let kept = reserved(self);
        let idle = |job: &JobId| {
            let pending = &self.jobs[job];
            let is_free = |(id, member): &(&WorkerId, &Member)| {
                let alone = self.must_run_alone(pending);
                let has_room = if alone {
                    member.leases.is_empty() && member.revoked.is_empty()
                } else {
                    member.idle() > 0 && kept != Some(**id)
                };
                member.takes_jobs() && has_room && may_have(self, pending, **id)
            };
            self.members.iter().find(is_free).map(|(id, _)| *id)
        };
        let comes_last = |job: &JobId| self.queued_jobs() > 0 && self.awaits_new_worker(*job);
        for job in self.queue.iter().filter(|job| !comes_last(job)) {
            assert_eq!(idle(job), None, "a worker is idle and job {job} waits");
        }
        let is_shared = |job: &&JobId| !self.must_run_alone(&self.jobs[*job]);
        if self.queued_jobs() == 0 {
            for job in self.anticipated_queue.iter().filter(is_shared) {
                assert_eq!(idle(job), None, "a worker is idle and job {job} could run");
            }
        }
    }
}
