//! Admission of workers: same protocol, build, numerics and effects, and the same results.
//!
//! Numerics are compared twice: by the digest of a fixed model when a worker announces itself, and by the
//! case's own reference individual, which each worker computes once it holds the case. The first worker of a
//! run sets the expected result, which others must match to the last bit or within the tolerance of the case.
use super::{
    admission_rules::{malformed, model, refusal_reason, sanitized},
    drain::turn_away,
    member::Member,
    notice::Notice,
    roster::dismiss,
    state::Core,
};
use journal::event::Event;
use protocol::{
    announce::Announcement,
    case::Reproducibility,
    id::WorkerId,
    message::{Heartbeat, ToWorker},
    proof::{MAX_SAMPLES, ReferenceResult},
};
use std::time::Duration;

/// Maximum number of refused workers remembered, so that each is reported once.
const MOST_REFUSED: usize = 4096;

/// Handles the announcement of a worker: admits or refuses it.
pub(super) fn announce(core: &mut Core, from: WorkerId, announcement: Announcement, now: Duration) {
    if let Some(reason) = malformed(&announcement).or_else(|| refusal_reason(core, &announcement)) {
        let host = sanitized(&announcement.host);
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

/// Sends a worker the reason for its refusal, and notifies the user once.
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

/// Handles a worker with another version of the wire protocol: answers in this version, so that the worker
/// can report the mismatch, and notifies the user once.
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

/// Returns whether a worker can be given jobs; `None` if it has just been refused.
pub(super) fn is_ready(core: &mut Core, from: WorkerId, beat: &Heartbeat) -> Option<bool> {
    let expected = core.options.case;
    match beat.case {
        None => return Some(false),
        Some(case) if case != expected => {
            let reason = format!(
                "case is {case}, but this run's is {expected} and the worker was told so; use \
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

/// Checks a worker's result of the case's reference individual against that of the run's first worker; the
/// first such result becomes the reference.
fn agreement(core: &mut Core, proof: &ReferenceResult) -> Result<(), String> {
    let tolerance = match core.options.repeats {
        Reproducibility::Within(tolerance) => tolerance,
        Reproducibility::Bits | Reproducibility::Unknown => 0.0,
    };
    if let ReferenceResult::Values(values) = proof
        && values.len() > MAX_SAMPLES
    {
        let count = values.len();
        return Err(format!(
            "proof has {count} values, at most {MAX_SAMPLES} are allowed: use the same build of horsehead-worker"
        ));
    }
    let Some(expected) = &core.options.proof else {
        // where every machine fails at it, the run's own jobs say so
        if *proof != ReferenceResult::Failed {
            core.options.proof = Some(proof.clone());
            let proof = proof.clone();
            core.record(Event::Proved { proof });
        }
        return Ok(());
    };
    expected.compare(proof, tolerance).map_err(|differs| {
        let remedy = match core.options.repeats {
            Reproducibility::Bits => "use the same build of horsehead-worker",
            Reproducibility::Within(_) | Reproducibility::Unknown => {
                "use the same program and files on every machine (`reference_tolerance` of the case says how \
                 much results may differ)"
            }
        };
        format!(
            "proof is {differs}: the reference individual of the case gives a different result on this \
             machine; {remedy}, or do not use this machine"
        )
    })
}

/// Removes a worker that has already joined from the run and tells it the reason.
fn expel(core: &mut Core, worker: WorkerId, reason: String) -> Option<bool> {
    let member = dismiss(core, worker, "it was refused", core.clocks.now)?;
    refuse(core, worker, member.announcement.host, reason);
    None
}
