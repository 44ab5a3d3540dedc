//! Answers to control requests about the workers of a run.
use super::control::messages::{ControlReply, ControlRequest, HeldJob, WorkerPhase, WorkerReport};
use crate::scheduler::{ConnectedWorker, Drain};
use protocol::{id::WorkerId, name::NO_CERTIFICATE};

/// Answers a control request: returns the workers to drain, with the way to drain each, and the reply.
pub(super) fn answer(
    question: &ControlRequest,
    crew: Vec<ConnectedWorker>,
    name: impl Fn(WorkerId) -> Option<String>,
    is_local: impl Fn(&ConnectedWorker) -> bool,
) -> (Vec<(WorkerId, Drain)>, ControlReply) {
    let named = crew.into_iter().map(|hand| {
        let name = name(hand.id).unwrap_or_else(|| NO_CERTIFICATE.to_owned());
        let local = is_local(&hand);
        (hand.id, worker(hand, name, local))
    });
    let all: Vec<(WorkerId, WorkerReport)> = named.collect();
    let (names, how) = match question {
        ControlRequest::List => {
            let workers = all.into_iter().map(|(_, worker)| worker);
            return (Vec::new(), ControlReply::Workers(workers.collect()));
        }
        ControlRequest::Drain { names, now, end } => (
            names,
            Drain {
                now: *now,
                end: *end,
            },
        ),
    };
    let is = |worker: &WorkerReport, name: &String| {
        [&worker.name, &worker.host, &worker.id].contains(&name)
    };
    let stranger = |name: &&String| !all.iter().any(|(_, worker)| is(worker, name));
    if let Some(stranger) = names.iter().find(stranger) {
        let mut known: Vec<&str> = all.iter().map(|(_, worker)| worker.name.as_str()).collect();
        known.dedup();
        return (
            Vec::new(),
            ControlReply::Error(format!(
                "no worker, host or id is called \"{stranger}\"; there are {}",
                if known.is_empty() {
                    "none".to_owned()
                } else {
                    known.join(", ")
                }
            )),
        );
    }
    let meant = |(_, worker): &(WorkerId, WorkerReport)| {
        names.is_empty() || names.iter().any(|name| is(worker, name))
    };
    let (ids, workers): (Vec<WorkerId>, Vec<WorkerReport>) = all.into_iter().filter(meant).unzip();
    (
        ids.into_iter().map(|id| (id, how)).collect(),
        ControlReply::Workers(workers),
    )
}

fn worker(hand: ConnectedWorker, name: String, local: bool) -> WorkerReport {
    let present_s = hand.present.as_secs_f64();
    WorkerReport {
        name,
        id: hand.id.to_string(),
        host: hand.host,
        local,
        slots: hand.slots,
        version: hand.build,
        state: match (hand.is_drained, hand.is_ready) {
            (true, _) if hand.jobs.is_empty() => WorkerPhase::Drained,
            (true, _) => WorkerPhase::Draining,
            (false, true) => WorkerPhase::Working,
            (false, false) => WorkerPhase::Joining,
        },
        jobs: hand
            .jobs
            .iter()
            .map(|(job, held)| HeldJob {
                job: job.0,
                for_s: held.as_secs_f64(),
            })
            .collect(),
        done: hand.done,
        failed: hand.failed,
        // of a worker that has just come nothing is known yet
        per_minute: 60.0 * hand.done as f64 / present_s.max(1.0),
        present_s,
        last_seen_s: hand.silent.as_secs_f64(),
    }
}
