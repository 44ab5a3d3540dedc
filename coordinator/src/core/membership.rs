//! Who takes part, and who is lost.
use super::input::Command;
use super::{
    Core, assign,
    notice::Notice,
    policy::Failures,
    result,
    state::{Member, Spent},
};
use protocol::{
    announce::Announcement,
    event::Event,
    id::WorkerId,
    job::Failure,
    message::{Beat, FromWorker, ToWorker},
    wire,
};
use std::time::Duration;

/// More slots than any machine has: a number beyond it is a mistake.
const MOST_SLOTS: u32 = 4096;

pub(super) fn heard(core: &mut Core, from: WorkerId, message: FromWorker, now: Duration) {
    let known = core
        .members
        .get_mut(&from)
        .map(|member| member.heard = now)
        .is_some();
    match message {
        FromWorker::Announce(_) if core.closing => {}
        FromWorker::Announce(announcement) => announce(core, from, *announcement, now),
        FromWorker::Beat(beat) if known => beaten(core, from, &beat, now),
        FromWorker::Beat(_) => core.send(from, ToWorker::Identify),
        FromWorker::Done(done) => {
            if !known {
                core.send(from, ToWorker::Identify);
            }
            result::done(core, from, *done, now);
        }
        FromWorker::Leaving { reason } if known => leave(core, from, reason, now),
        FromWorker::Leaving { .. } => {}
    }
}

fn announce(core: &mut Core, from: WorkerId, announcement: Announcement, now: Duration) {
    if let Some(reason) = objection(core, &announcement) {
        if core.refused.insert(from) {
            let host = announcement.host;
            core.notice(Notice::Refused {
                worker: from,
                host,
                reason: reason.clone(),
            });
        }
        core.send(from, ToWorker::Refused { reason });
        return;
    }
    if !core.members.contains_key(&from) {
        admit(core, from, announcement, now);
    }
    let (epoch, case, case_bytes) = (
        core.options.epoch,
        core.options.case,
        core.options.case_bytes,
    );
    core.send(
        from,
        ToWorker::Admitted {
            epoch,
            case,
            case_bytes,
        },
    );
}

fn objection(core: &Core, announcement: &Announcement) -> Option<String> {
    if announcement.protocol != wire::VERSION {
        return Some(format!(
            "protocol is {}, this coordinator speaks {}: use the same build everywhere",
            announcement.protocol,
            wire::VERSION
        ));
    }
    if !(1..=MOST_SLOTS).contains(&announcement.slots) {
        return Some(format!(
            "slots is {}, allowed are 1 to {MOST_SLOTS}: set --slots",
            announcement.slots
        ));
    }
    let expected = core.options.model_digest.as_ref()?;
    (*expected != announcement.model_digest).then(|| {
        format!(
            "model_digest is {}, this run's is {expected}: use the same build of horsehead-worker \
             on every machine",
            announcement.model_digest
        )
    })
}

fn admit(core: &mut Core, worker: WorkerId, announcement: Announcement, now: Duration) {
    let (host, slots) = (announcement.host.clone(), announcement.slots);
    let model_digest = announcement.model_digest.clone();
    core.options
        .model_digest
        .get_or_insert_with(|| model_digest.clone());
    core.refused.remove(&worker);
    core.members.insert(
        worker,
        Member {
            announcement,
            since: now,
            heard: now,
            ready: false,
            leases: Vec::new(),
            alone: false,
            claims: Vec::new(),
            done: 0,
            failed: 0,
            spent: Spent::default(),
        },
    );
    core.notice(Notice::Joined {
        worker,
        host: host.clone(),
        slots,
    });
    core.out.push(Command::Record(Event::Joined {
        worker,
        host,
        slots,
        model_digest,
    }));
}

fn beaten(core: &mut Core, from: WorkerId, beat: &Beat, now: Duration) {
    let case = core.options.case;
    if let Some(member) = core.members.get_mut(&from) {
        member.ready = beat.case == Some(case);
        for lease in &mut member.leases {
            if lease.running.is_none() && beat.running.contains(&lease.attempt) {
                lease.running = Some(now);
            }
        }
        member.claims.clear();
    }
    assign::reconcile(core, from, beat, now);
}

fn leave(core: &mut Core, worker: WorkerId, reason: String, now: Duration) {
    let Some(member) = remove(core, worker, &reason, now) else {
        return;
    };
    for lease in member.leases {
        // nobody is to blame
        assign::release(core, worker, lease.attempt.job);
    }
    // it waits for this, lest the end of its connection be heard first and taken for a loss
    core.send(worker, ToWorker::Ended);
    core.notice(Notice::Left { worker, reason });
}

/// Gives up a worker and offers what it held to others.
pub(super) fn lose(core: &mut Core, worker: WorkerId, reason: &str, now: Duration) {
    let Some(member) = remove(core, worker, reason, now) else {
        return;
    };
    core.counts.lost += 1;
    let (jobs, slots) = (member.leases.len(), member.slots());
    core.notice(Notice::Lost {
        worker,
        reason: reason.to_owned(),
        jobs,
    });
    for (place, lease) in member.leases.into_iter().enumerate() {
        let job = lease.attempt.job;
        // what still waited there is not to blame
        if lease.running.is_none() && place >= slots {
            assign::release(core, worker, job);
            continue;
        }
        let losses = core.jobs.get(&job).map_or(0, |job| job.failures.losses) + 1;
        result::failed(core, worker, job, Failure::Lost { workers: losses }, now);
    }
}

fn remove(core: &mut Core, worker: WorkerId, reason: &str, now: Duration) -> Option<Member> {
    let member = core.members.remove(&worker)?;
    core.counts.past.add(&account(&member, now));
    let reason = reason.to_owned();
    core.out
        .push(Command::Record(Event::Left { worker, reason }));
    Some(member)
}

/// A worker's slot time until now.
pub(super) fn account(member: &Member, now: Duration) -> Spent {
    let connected = now.saturating_sub(member.since).as_micros();
    let connected = u64::try_from(connected).unwrap_or(u64::MAX);
    Spent {
        connected_us: connected.saturating_mul(u64::from(member.announcement.slots)),
        ..member.spent
    }
}

pub(super) fn check_silence(core: &mut Core, now: Duration) {
    let silence = core.options.policy.silence;
    let silent: Vec<WorkerId> = core
        .members
        .iter()
        .filter(|(_, member)| now.saturating_sub(member.heard) > silence)
        .map(|(id, _)| *id)
        .collect();
    for worker in silent {
        lose(core, worker, "it fell silent", now);
    }
}

/// If nobody called for a while, messages wait to be read: no worker is to blame for it.
pub(super) fn forgive_stall(core: &mut Core, now: Duration) {
    let gap = now.saturating_sub(core.last_call);
    core.last_call = now;
    if gap <= core.options.policy.stall || core.members.is_empty() {
        return;
    }
    for member in core.members.values_mut() {
        member.heard = (member.heard + gap).min(now);
        for lease in &mut member.leases {
            lease.sent = (lease.sent + gap).min(now);
            lease.running = lease.running.map(|running| (running + gap).min(now));
        }
    }
    let ms = u64::try_from(gap.as_millis()).unwrap_or(u64::MAX);
    core.notice(Notice::Stalled { ms });
}

/// Tells people, once, that jobs wait and nobody is there.
pub(super) fn check_lonely(core: &mut Core, now: Duration) {
    if !core.members.is_empty() || core.queue.is_empty() {
        core.lonely_since = None;
        core.told_lonely = false;
        return;
    }
    let since = *core.lonely_since.get_or_insert(now);
    if !core.told_lonely && now.saturating_sub(since) >= core.options.policy.lonely {
        core.told_lonely = true;
        let (jobs, refused) = (core.queue.len(), core.refused.len());
        core.notice(Notice::NoWorker { jobs, refused });
    }
}

/// Whether a job must run alone.
pub(super) const fn is_suspect(failures: Failures, suspect: u32) -> bool {
    failures.losses >= suspect
}
