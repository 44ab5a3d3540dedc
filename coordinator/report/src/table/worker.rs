//! Who computed, and how the slots spent their time.
use crate::document::{Row, Table};
use crate::{
    data::WorkerUse,
    number::{NONE, count, duration, percent},
};
use dispatch::account::RunAccount;
use protocol::event::Spent;

/// What each worker did.
pub(crate) fn workers(workers: &[WorkerUse]) -> Table {
    let rows = workers.iter().map(|worker| {
        Row::new(
            worker.name.clone(),
            [
                worker.host.clone(),
                worker.slots.to_string(),
                count(worker.done),
                count(worker.failed),
                duration(worker.busy_s),
                worker.busy_share().map_or_else(|| NONE.to_owned(), percent),
            ],
        )
    });
    Table::new(
        "Workers",
        [
            "worker",
            "host",
            "slots",
            "jobs done",
            "failed",
            "computing",
            "busy",
        ],
        rows.collect(),
    )
    .noted(["Busy: time spent on accepted results over slots times the time attached."])
}

/// How slots spent their time, kind by kind.
pub fn slot_time(spent: &Spent) -> Table {
    let what = |kind: &str| match kind {
        "useful" => "computing results that were used",
        "barrier" => "waiting for results of others",
        "starved" => "waiting for the case, an order or the journal",
        "speculative" => "copies that came second",
        "failed" => "attempts that crashed or ran out of time",
        _ => "attempts whose worker was lost",
    };
    let rows = spent.kinds().map(|(kind, us)| {
        let share = us as f64 / spent.connected_us.max(1) as f64;
        Row::new(
            kind,
            [
                duration(us as f64 / 1e6),
                percent(share),
                what(kind).to_owned(),
            ],
        )
    });
    Table::new(
        "Slot time",
        ["use", "time", "share", "what it was"],
        rows.into(),
    )
    .noted([format!(
        "Slots were connected for {} in all.",
        duration(spent.connected_us as f64 / 1e6)
    )])
}

/// What the machines did.
pub fn hosts(account: &RunAccount) -> Table {
    let rows = account.hosts().into_iter().map(|(host, used)| {
        let share = used.spent.useful_us as f64 / used.spent.connected_us.max(1) as f64;
        Row::new(
            host,
            [
                count(used.workers),
                used.slots.to_string(),
                count(used.done),
                count(used.failed),
                duration(used.spent.useful_us as f64 / 1e6),
                percent(share),
            ],
        )
    });
    Table::new(
        "Machines",
        [
            "machine", "workers", "slots", "results", "failed", "useful", "share",
        ],
        rows.collect(),
    )
}

/// How long jobs took, kind by kind.
pub fn jobs(account: &RunAccount) -> Table {
    let rows = account.jobs.iter().map(|(kind, used)| {
        Row::new(
            *kind,
            [
                count(used.results),
                count(used.machine_failed),
                duration(used.median_s),
                duration(used.usual_s),
                duration(used.longest_s),
                duration(used.wall_s),
                duration(used.processor_s),
            ],
        )
    });
    Table::new(
        "Jobs",
        [
            "kind",
            "results",
            "machine failed",
            "median",
            "95 %",
            "longest",
            "in the slot",
            "processor",
        ],
        rows.collect(),
    )
}
