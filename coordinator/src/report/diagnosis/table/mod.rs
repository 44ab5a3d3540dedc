//! The tables of a diagnosis: for the page and for the terminal.
mod answer;
mod ground;
mod proof;
mod suspicion;
mod wander;

pub(super) use answer::{genes, sizes};
pub(super) use ground::{numerics, stages};
pub(super) use proof::{gaps, paper};
pub(super) use suspicion::{generics, limits, look_alikes, suspects};
pub(super) use wander::wander;

use crate::report::table::{Label, Row, Table};

fn table<const N: usize>(title: impl Into<String>, head: [&str; N], rows: Vec<Row>) -> Table {
    Table {
        title: title.into(),
        head: head.map(str::to_owned).to_vec(),
        rows,
        notes: Vec::new(),
    }
}

fn row(label: impl Into<String>, cells: impl IntoIterator<Item = String>) -> Row {
    Row::Values(Label::Text(label.into()), cells.into_iter().collect())
}
