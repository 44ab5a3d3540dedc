//! Who may take part: the same protocol, build, numerics and effects, and the same bits.
//!
//! Numerics are compared twice: by the digest of a fixed model when a worker announces itself, and
//! by the case's own reference individual, which each worker computes once it holds the case. The
//! first worker of a run sets what the others must come to: to the last bit, or within what the case says.
use super::{
    admission_rules::{malformed, model, objection, shown},
    drain::turn_away,
    member::Member,
    notice::Notice,
    roster::dismiss,
    state::Core,
};
use protocol::{
    announce::Announcement,
    case::Repeats,
    event::Event,
    id::WorkerId,
    message::{Beat, ToWorker},
    proof::{MOST_SAMPLES, Proof},
};
use std::time::Duration;

/// Refused workers that are remembered, so that each is spoken of once.
const MOST_REFUSED: usize = 4096;

/// A worker introduces itself.
pub(super) fn announce(core: &mut Core, from: WorkerId, announcement: Announcement, now: Duration) {
    if let Some(reason) = malformed(&announcement).or_else(|| objection(core, &announcement)) {
        let host = shown(&announcement.host);
        refuse(core, from, host, reason);
        return;
    }
    if turn_away(core, from) {
        return;
    }
    if !core.members.contains_key(&from) {
        admit(core, from, announcement, now);
    }
    let admitted = ToWorker::Admitted {
        epoch: core.options.epoch,
        case: core.options.case,
        case_bytes: core.options.case_bytes,
    };
    core.send(from, admitted);
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

fn admit(core: &mut Core, worker: WorkerId, announcement: Announcement, now: Duration) {
    let (host, slots) = (announcement.host.clone(), announcement.slots);
    let model = model(core, &announcement);
    let model_digest = model.map(|model| model.digest.clone()).unwrap_or_default();
    if let Some(model) = model {
        let expected = &mut core.options.model_digest;
        expected.get_or_insert_with(|| model_digest.clone());
        let effects = model.effects.iter();
        core.effects
            .get_or_insert_with(|| effects.map(|effect| effect.id.clone()).collect());
    }
    core.refused.remove(&worker);
    let mut member = Member::new(announcement, &core.clocks, now);
    member.drained = core.drained.contains_key(&worker);
    core.members.insert(worker, member);
    core.notice(Notice::Joined {
        worker,
        host: host.clone(),
        slots,
    });
    core.record(Event::Joined {
        worker,
        host,
        slots,
        model_digest,
    });
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
    let Some(proof) = &beat.proof else {
        return Some(false);
    };
    match agreement(core, proof) {
        Ok(()) => Some(true),
        Err(reason) => expel(core, from, reason),
    }
}

/// Whether a machine computes what the others compute; the first one says what that is.
fn agreement(core: &mut Core, proof: &Proof) -> Result<(), String> {
    let tolerance = match core.options.repeats {
        Repeats::Within(tolerance) => tolerance,
        Repeats::Bits | Repeats::Unknown => 0.0,
    };
    if let Proof::Values(values) = proof
        && values.len() > MOST_SAMPLES
    {
        let count = values.len();
        return Err(format!(
            "proof has {count} values, allowed are {MOST_SAMPLES}: use the same build of horsehead-worker"
        ));
    }
    let Some(expected) = &core.options.proof else {
        // where every machine fails at it, the run's own jobs say so
        if *proof != Proof::Failed {
            core.options.proof = Some(proof.clone());
            let proof = proof.clone();
            core.record(Event::Proved { proof });
        }
        return Ok(());
    };
    expected.agrees(proof, tolerance).map_err(|differs| {
        let remedy = match core.options.repeats {
            Repeats::Bits => "use the same build of horsehead-worker",
            Repeats::Within(_) | Repeats::Unknown => {
                "use the same program and files on every machine (`reference_tolerance` of the case says how \
                 much results may differ)"
            }
        };
        format!(
            "proof is {differs}: the reference individual of the case comes out differently on this \
             machine; {remedy}, or leave this machine out"
        )
    })
}

/// Refuses a worker that takes part already.
fn expel(core: &mut Core, worker: WorkerId, reason: String) -> Option<bool> {
    let member = dismiss(core, worker, "it was refused", core.clocks.now)?;
    refuse(core, worker, member.announcement.host, reason);
    None
}
