//! Answers to control requests about the workers of a run.
use super::control::words::{Job, Question, Reply, State, Worker};
use crate::scheduler::{Drain, Hand};
use protocol::{id::WorkerId, name::ANYONE};

/// Returns the workers to drain with the options, and the reply to the control request.
pub(super) fn answer(
    question: &Question,
    crew: Vec<Hand>,
    name: impl Fn(WorkerId) -> Option<String>,
) -> (Vec<(WorkerId, Drain)>, Reply) {
    let named = crew.into_iter().map(|hand| {
        let name = name(hand.id).unwrap_or_else(|| ANYONE.to_owned());
        (hand.id, worker(hand, name))
    });
    let all: Vec<(WorkerId, Worker)> = named.collect();
    let (names, how) = match question {
        Question::List => {
            let workers = all.into_iter().map(|(_, worker)| worker);
            return (Vec::new(), Reply::Workers(workers.collect()));
        }
        Question::Drain { names, now, end } => (
            names,
            Drain {
                now: *now,
                end: *end,
            },
        ),
    };
    let is =
        |worker: &Worker, name: &String| [&worker.name, &worker.host, &worker.id].contains(&name);
    let stranger = |name: &&String| !all.iter().any(|(_, worker)| is(worker, name));
    if let Some(stranger) = names.iter().find(stranger) {
        let mut known: Vec<&str> = all.iter().map(|(_, worker)| worker.name.as_str()).collect();
        known.dedup();
        return (
            Vec::new(),
            Reply::Error(format!(
                "no worker, host or id is called \"{stranger}\"; there are {}",
                if known.is_empty() {
                    "none".to_owned()
                } else {
                    known.join(", ")
                }
            )),
        );
    }
    let meant = |(_, worker): &(WorkerId, Worker)| {
        names.is_empty() || names.iter().any(|name| is(worker, name))
    };
    let (ids, workers): (Vec<WorkerId>, Vec<Worker>) = all.into_iter().filter(meant).unzip();
    (
        ids.into_iter().map(|id| (id, how)).collect(),
        Reply::Workers(workers),
    )
}

fn worker(hand: Hand, name: String) -> Worker {
    let present_s = hand.present.as_secs_f64();
    Worker {
        name,
        id: hand.id.to_string(),
        host: hand.host,
        slots: hand.slots,
        version: hand.build,
        state: match (hand.is_drained, hand.is_ready) {
            (true, _) if hand.jobs.is_empty() => State::Drained,
            (true, _) => State::Draining,
            (false, true) => State::Working,
            (false, false) => State::Joining,
        },
        jobs: hand
            .jobs
            .iter()
            .map(|(job, held)| Job {
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
