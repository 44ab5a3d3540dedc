//! Answers to control requests about the workers of a run.
use super::control::messages::{ControlReply, ControlRequest};
use crate::scheduler::{Drain, WorkerReport};
use protocol::id::WorkerId;

/// Answers a control request about the workers of a run: returns those to drain, with the way to drain each, and the
/// reply.
pub(super) fn answer(
    question: &ControlRequest,
    all: Vec<(WorkerId, WorkerReport)>,
) -> (Vec<(WorkerId, Drain)>, ControlReply) {
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
