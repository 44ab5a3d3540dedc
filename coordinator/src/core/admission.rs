//! Who may take part: the same protocol, build, numerics and effects, and the same bits.
//!
//! Numerics are compared twice: by the digest of a fixed model when a worker announces itself, and
//! by the case's own reference individual, which each worker computes once it holds the case. The
//! first worker of a run sets what the others must come to, to the last bit.
use super::{Core, account::Purse, input::Command, membership, notice::Notice, state::Member};
use protocol::{
    announce::Announcement,
    event::Event,
    id::WorkerId,
    message::{Beat, ToWorker},
    wire,
};
use std::time::Duration;

/// More slots than any machine has: a number beyond it is a mistake.
const MOST_SLOTS: u32 = 4096;

/// More workers than any run has: so many are no workers.
const MOST_WORKERS: usize = 16 << 10;

/// Refused workers that are remembered, so that each is spoken of once.
const MOST_REFUSED: usize = 4096;

/// This program's version.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// A worker introduces itself.
pub(super) fn announce(core: &mut Core, from: WorkerId, announcement: Announcement, now: Duration) {
    if let Some(reason) = objection(core, &announcement) {
        let host = announcement.host;
        refuse(core, from, host, reason);
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

/// Tells a worker why it may not take part, and people once.
fn refuse(core: &mut Core, worker: WorkerId, host: String, reason: String) {
    if core.refused.len() < MOST_REFUSED && core.refused.insert(worker) {
        core.notice(Notice::Refused {
            worker,
            host,
            reason: reason.clone(),
        });
    }
    core.send(worker, ToWorker::Refused { reason });
}

fn objection(core: &Core, announcement: &Announcement) -> Option<String> {
    const SAME: &str = "use the same build of horsehead and horsehead-worker on every machine";
    let Announcement {
        protocol,
        build,
        model_digest,
        slots,
        effects,
        ..
    } = announcement;
    if *protocol != wire::VERSION {
        return Some(format!(
            "protocol is {protocol}, this coordinator speaks {}: {SAME}",
            wire::VERSION
        ));
    }
    if build.split(' ').next() != Some(VERSION) {
        return Some(format!(
            "build is {build}, this coordinator's is {VERSION}: {SAME}"
        ));
    }
    if !(1..=MOST_SLOTS).contains(slots) {
        return Some(format!(
            "slots is {slots}, allowed are 1 to {MOST_SLOTS}: set --slots"
        ));
    }
    if core.members.len() >= MOST_WORKERS {
        return Some(format!(
            "workers are {MOST_WORKERS} already: start fewer, with more slots"
        ));
    }
    if let Some(expected) = &core.options.model_digest
        && expected != model_digest
    {
        return Some(format!(
            "model_digest is {model_digest}, this run's is {expected}: {SAME}"
        ));
    }
    if let Some(expected) = &core.effects {
        let names: Vec<&String> = effects.iter().map(|effect| &effect.id).collect();
        let differs = |name: &&String| !expected.contains(*name);
        let more = names.iter().copied().find(differs);
        let fewer = expected.iter().find(|name| !names.contains(name));
        let difference = match (more, fewer) {
            (Some(more), _) => format!("{more} that the others do not know"),
            (None, Some(fewer)) => format!("no {fewer}, which the others know"),
            (None, None) => return None,
        };
        return Some(format!("effects has {difference}: {SAME}"));
    }
    None
}

fn admit(core: &mut Core, worker: WorkerId, announcement: Announcement, now: Duration) {
    let (host, slots) = (announcement.host.clone(), announcement.slots);
    let model_digest = announcement.model_digest.clone();
    core.options
        .model_digest
        .get_or_insert_with(|| model_digest.clone());
    core.effects.get_or_insert_with(|| {
        let effects = announcement.effects.iter();
        effects.map(|effect| effect.id.clone()).collect()
    });
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
            taken: Vec::new(),
            done: 0,
            failed: 0,
            purse: Purse::new(&core.clocks),
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

/// Whether a worker can be given jobs; none if it has just been refused.
pub(super) fn is_ready(core: &mut Core, from: WorkerId, beat: &Beat) -> Option<bool> {
    let Some(proof) = beat.proof.filter(|_| beat.case == Some(core.options.case)) else {
        return Some(false);
    };
    let Some(expected) = core.options.proof else {
        core.options.proof = Some(proof);
        let proved = Event::Proved { proof };
        core.out.push(Command::Record(proved));
        return Some(true);
    };
    if expected == proof {
        return Some(true);
    }
    let reason = format!(
        "proof is {proof}, this run's is {expected}: the reference individual of the case comes \
         out differently on this machine; use the same build of horsehead-worker, or leave this \
         machine out"
    );
    let member = membership::lose_refused(core, from)?;
    refuse(core, from, member.announcement.host, reason);
    None
}
