//! Definition of all tables, each column once.
//!
//! A new column is a line in one of the modules here; a new table needs a function there, a line in
//! [`Tables::begin`], and code that adds its rows.
mod about;
mod event;
mod result;

pub use about::gene_column;

use super::{
    column::Column,
    error::StoreError,
    row::{Brief, EffectRow, Evaluated, Fact, Happened, Scored},
    writer::{TableHandle, TableWriter},
};
use journal::Damage;
use journal::event::WorkerAccount;
use protocol::case::{Case, Unknown};

/// Handles of all tables of an export, by which rows are added to them.
pub(super) struct Tables {
    pub(super) run: TableHandle<Fact>,
    pub(super) genes: TableHandle<Unknown>,
    pub(super) evaluations: TableHandle<Evaluated>,
    pub(super) effects: TableHandle<EffectRow>,
    pub(super) results: TableHandle<Brief>,
    pub(super) scores: TableHandle<Scored>,
    pub(super) workers: TableHandle<WorkerAccount>,
    pub(super) events: TableHandle<Happened>,
    pub(super) damage: TableHandle<Damage>,
    pub(super) dictionary: TableHandle<(String, Column)>,
}

impl Tables {
    /// Defines all tables in the export's output, in a fixed order, and returns their handles.
    pub(super) fn begin(book: &mut TableWriter, case: &Case) -> Result<Self, StoreError> {
        Ok(Self {
            run: book.begin("run", about::run())?,
            genes: book.begin("genes", about::genes())?,
            evaluations: book.begin("evaluations", result::evaluations(case))?,
            effects: book.begin("effects", result::effects())?,
            results: book.begin("results", result::results(case))?,
            scores: book.begin("scores", result::scores(case))?,
            workers: book.begin("workers", event::workers())?,
            events: book.begin("events", event::events())?,
            damage: book.begin("damage", event::damage())?,
            dictionary: book.begin("dictionary", about::dictionary())?,
        })
    }
}

/// Names of all exported tables.
pub(super) const NAMES: [&str; 10] = [
    "run",
    "genes",
    "evaluations",
    "effects",
    "results",
    "scores",
    "workers",
    "events",
    "damage",
    "dictionary",
];
