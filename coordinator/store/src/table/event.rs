//! Tables of what happened: workers, events of the run, damage of its journal.
use crate::{column::Columns, row::Happened};
use dispatch::journal::Damage;
use protocol::event::{Spent, WorkerAccount};

pub(super) fn workers() -> Columns<WorkerAccount> {
    let mut columns = Columns::new()
        .text("worker", "its id", |row: &WorkerAccount| {
            Some(row.worker.to_string())
        })
        .text("host", "its machine", |row| Some(row.host.clone()))
        .integer("slots", "jobs it does at a time", |row| {
            Some(u64::from(row.slots))
        })
        .integer("done", "results of it that were accepted", |row| {
            Some(row.done)
        })
        .integer("failed", "attempts that failed there", |row| {
            Some(row.failed)
        })
        .real("connected_s", "slots times time connected [s]", |row| {
            Some(row.spent.connected_us as f64 / 1e6)
        });
    for (place, (kind, _)) in Spent::default().kinds().into_iter().enumerate() {
        let (name, about) = (
            format!("{kind}_s"),
            format!("of that, {kind}, as `horsehead explain` has it [s]"),
        );
        columns = columns.real(&name, &about, move |row| {
            let (_, us) = row.spent.kinds().into_iter().nth(place)?;
            Some(us as f64 / 1e6)
        });
    }
    columns
}

pub(super) fn events() -> Columns<Happened> {
    Columns::new()
        .integer(
            "journal_byte",
            "where it stands in the journal",
            |row: &Happened| Some(row.at_byte),
        )
        .integer("process", "coordinator process of the run, from 1", |row| {
            row.process.map(u64::from)
        })
        .integer("at_unix_ms", "when [ms since 1970 UTC]", |row| {
            row.at_unix_ms
        })
        .text("event", "opened, joined, left, proved or closed", |row| {
            Some(row.event.to_owned())
        })
        .text("worker", "whom it concerns", |row| {
            Some(row.worker?.to_string())
        })
        .text("host", "machine of a worker that joined", |row| {
            row.host.clone()
        })
        .integer("slots", "slots of a worker that joined", |row| {
            row.slots.map(u64::from)
        })
        .text(
            "detail",
            "why a worker left; model digest of one that joined; what the reference individual \
             came to",
            |row| row.detail.clone(),
        )
}

pub(super) fn damage() -> Columns<Damage> {
    Columns::new()
        .integer(
            "journal_byte",
            "where a stretch begins that could not be read",
            |row: &Damage| Some(row.at),
        )
        .integer("bytes", "how long it is", |row| Some(row.bytes))
        .text(
            "kind",
            "damaged, or torn: an unfinished record at the end",
            |row| Some(if row.torn { "torn" } else { "damaged" }.to_owned()),
        )
}
