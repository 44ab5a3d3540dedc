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

/// Longest name of a machine, a build or a model (bytes).
const MOST_NAME: usize = 255;

/// Longest list of kinds of job, and of effects (bytes, encoded): ten times what ours have.
const MOST_KINDS: usize = 4 << 10;
const MOST_EFFECTS: usize = 1 << 20;

/// How much of a text that cannot be trusted people are shown (characters).
const MOST_SHOWN: usize = 200;

/// This program's version.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// A worker introduces itself.
pub(super) fn announce(core: &mut Core, from: WorkerId, announcement: Announcement, now: Duration) {
    if let Some(reason) = absurdity(&announcement).or_else(|| objection(core, &announcement)) {
        let host = shown(&announcement.host);
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

/// A worker speaks another version of the wire: it is answered in ours, so that it can say why it
/// does not work, and people are told once.
pub(super) fn other_version(core: &mut Core, worker: WorkerId, version: u8) {
    let is_member = core.members.contains_key(&worker);
    if !is_member && core.refused.len() < MOST_REFUSED && core.refused.insert(worker) {
        core.notice(Notice::OtherVersion { worker, version });
    }
    core.send(worker, ToWorker::Identify);
}

/// The beginning of a text of somebody else, without what a terminal would obey.
pub(super) fn shown(text: &str) -> String {
    let plain = text.chars().filter(|letter| !letter.is_control());
    plain.take(MOST_SHOWN).collect()
}

/// What no worker of ours would say of itself; it is kept, shown and written down, so there is an
/// end to it.
fn absurdity(announcement: &Announcement) -> Option<String> {
    let Announcement {
        build,
        model_digest,
        host,
        job_kinds,
        effects,
        ..
    } = announcement;
    for (field, text) in [
        ("host", host),
        ("build", build),
        ("model_digest", model_digest),
    ] {
        if text.len() > MOST_NAME {
            let bytes = text.len();
            return Some(format!(
                "{field} has {bytes} bytes, allowed are {MOST_NAME}"
            ));
        }
        if text.chars().any(char::is_control) {
            return Some(format!("{field} holds control characters"));
        }
    }
    // what cannot be encoded came over no wire
    let bytes = |encoded: Result<Vec<u8>, wire::WireError>| encoded.map_or(0, |it| it.len());
    for (field, bytes, most) in [
        ("job_kinds", bytes(wire::encode(job_kinds)), MOST_KINDS),
        ("effects", bytes(wire::encode(effects)), MOST_EFFECTS),
    ] {
        if bytes > most {
            return Some(format!("{field} has {bytes} bytes, allowed are {most}"));
        }
    }
    None
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
    let expected = core.options.case;
    match beat.case {
        None => return Some(false),
        Some(case) if case != expected => {
            let reason = format!(
                "case is {case}, this run's is {expected}: it was told so and took another; use \
                 the same build of horsehead-worker"
            );
            return expel(core, from, reason);
        }
        Some(_) => {}
    }
    let Some(proof) = beat.proof else {
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
    expel(core, from, reason)
}

/// Refuses a worker that takes part already.
fn expel(core: &mut Core, worker: WorkerId, reason: String) -> Option<bool> {
    let member = membership::lose_refused(core, worker)?;
    refuse(core, worker, member.announcement.host, reason);
    None
}
