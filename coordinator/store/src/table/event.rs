//! Definition of the tables of workers, of run events, and of damaged sections of the journal.
use crate::{column::Columns, row::Happened};
use journal::Damage;
use journal::event::{Spent, WorkerAccount};

pub(super) fn workers() -> Columns<WorkerAccount> {
    let mut columns = Columns::new()
        .text("worker", "its id", |row: &WorkerAccount| {
            Some(row.worker.to_string())
        })
        .text("host", "its machine", |row| Some(row.host.clone()))
        .integer(
            "slots",
            "number of jobs that it computes in parallel",
            |row| Some(u64::from(row.slots)),
        )
        .integer("done", "number of its results that were accepted", |row| {
            Some(row.done)
        })
        .integer("failed", "number of attempts that failed on it", |row| {
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
            "byte offset of the event in the journal",
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
        .text(
            "worker",
            "id of the worker that the event concerns",
            |row| Some(row.worker?.to_string()),
        )
        .text("host", "machine of a worker that joined", |row| {
            row.host.clone()
        })
        .integer("slots", "slots of a worker that joined", |row| {
            row.slots.map(u64::from)
        })
        .text(
            "detail",
            "why a worker left; model digest of a worker that joined; result of the reference \
             individual",
            |row| row.detail.clone(),
        )
}

pub(super) fn damage() -> Columns<Damage> {
    Columns::new()
        .integer(
            "journal_byte",
            "byte offset at which an unreadable part of the journal begins",
            |row: &Damage| Some(row.at),
        )
        .integer("bytes", "length of the unreadable part [bytes]", |row| {
            Some(row.bytes)
        })
        .text(
            "kind",
            "damaged, or torn: an unfinished record at the end",
            |row| Some(if row.torn { "torn" } else { "damaged" }.to_owned()),
        )
}
