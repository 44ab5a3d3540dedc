//! Tables from one description: for the terminal and for HTML.
//!
//! Here is only how a table is set; `compare`, `head`, `single` and `worker` fill it.
mod compare;
mod gap;
mod head;
mod single;
mod whole_box;
mod work;
mod worker;

pub use compare::{table_3, table_4};
pub use gap::gap;
pub use head::{head_modes, head_pair, head_statics};
pub use single::{balance, genes, simulation};
pub use whole_box::whole_box;
pub use work::work_precision;
pub use worker::{hosts, jobs, slot_time, workers};

use comfy_table::{Attribute, Cell, CellAlignment, LineStyle, presets};
use maud::{Markup, html};
use protocol::case::{Coefficient, Gene, Quantity};

/// A table.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What it shows.
    pub title: String,
    /// Heads of the columns; the first belongs to the labels.
    pub head: Vec<String>,
    /// Rows from top to bottom.
    pub rows: Vec<Row>,
    /// Definitions and remarks below it, one sentence each.
    pub notes: Vec<String>,
}

/// One row.
#[derive(Clone, Debug, PartialEq)]
pub enum Row {
    /// Heads the rows that follow.
    Group(String),
    /// A label and one cell per further column.
    Values(Label, Vec<String>),
}

impl Table {
    /// Whether a column holds words, not numbers: those start at the left, and may be long.
    fn is_prose(&self, column: usize) -> bool {
        const LONGEST_NUMBER: usize = 32;
        let cells = self.rows.iter().filter_map(|row| match row {
            Row::Group(_) => None,
            Row::Values(_, cells) => cells.get(column),
        });
        let mut lengths = cells.map(|cell| cell.chars().count());
        lengths.any(|length| length > LONGEST_NUMBER)
    }
}

/// What a row is about.
#[derive(Clone, Debug, PartialEq)]
pub enum Label {
    /// In words.
    Text(String),
    /// A coefficient; with its symbol where the medium can set it.
    Gene(Coefficient),
}

impl Row {
    /// A row about something in words.
    fn new(label: impl Into<String>, cells: impl IntoIterator<Item = String>) -> Self {
        Self::Values(Label::Text(label.into()), cells.into_iter().collect())
    }
}

impl Label {
    /// That of a gene; a parameter of an effect has no symbol.
    pub(super) fn of(gene: &Gene) -> Self {
        match gene.quantity {
            Quantity::Coefficient { name, .. } => Self::Gene(name),
            Quantity::Effect { .. } => Self::Text(gene.label()),
        }
    }
}

/// What a coefficient is, in words.
pub(super) const fn meaning(gene: Coefficient) -> &'static str {
    match gene {
        Coefficient::Kb1 => "axial stiffness",
        Coefficient::Kb23 => "shear stiffness",
        Coefficient::Kb4 => "torsional stiffness",
        Coefficient::Kb56 => "bending stiffness",
        Coefficient::Cb1 => "axial damping",
        Coefficient::Cb23 => "shear damping",
        Coefficient::Cb4 => "torsional damping",
        Coefficient::Cb56 => "bending damping",
        Coefficient::Kc => "contact stiffness",
        Coefficient::Cc => "contact damping",
    }
}

/// Letter and index of a coefficient's symbol.
pub(super) const fn symbol(gene: Coefficient) -> (&'static str, &'static str) {
    match gene {
        Coefficient::Kb1 => ("K", "b1"),
        Coefficient::Kb23 => ("K", "b23"),
        Coefficient::Kb4 => ("K", "b4"),
        Coefficient::Kb56 => ("K", "b56"),
        Coefficient::Cb1 => ("C", "b1"),
        Coefficient::Cb23 => ("C", "b23"),
        Coefficient::Cb4 => ("C", "b4"),
        Coefficient::Cb56 => ("C", "b56"),
        Coefficient::Kc => ("K", "c"),
        Coefficient::Cc => ("C", "c"),
    }
}

/// Sets a table as text, with its title and notes; `styled` where the terminal shows bold.
pub fn text(table: &Table, styled: bool) -> String {
    let bold = |cell: Cell| {
        if styled {
            cell.add_attribute(Attribute::Bold)
        } else {
            cell
        }
    };
    let mut grid = comfy_table::Table::new();
    // rules above, below and under the head only, as in print
    grid.load_style(presets::UTF8_HORIZONTAL_ONLY.row_separator(LineStyle::none()));
    if styled {
        grid.enforce_styling();
    } else {
        grid.force_no_tty();
    }
    grid.set_header(table.head.iter().enumerate().map(|(column, head)| {
        let alignment = if column == 0 || table.is_prose(column - 1) {
            CellAlignment::Left
        } else {
            CellAlignment::Right
        };
        bold(Cell::new(head).set_alignment(alignment))
    }));
    for row in &table.rows {
        match row {
            Row::Group(name) => {
                grid.add_row(vec![bold(Cell::new(name))]);
            }
            Row::Values(label, cells) => {
                let label = match label {
                    Label::Text(text) => format!("  {text}"),
                    Label::Gene(gene) => format!("  {:<5} {}", gene.as_str(), meaning(*gene)),
                };
                let cells = cells.iter().enumerate().map(|(column, cell)| {
                    Cell::new(cell).set_alignment(if table.is_prose(column) {
                        CellAlignment::Left
                    } else {
                        CellAlignment::Right
                    })
                });
                grid.add_row(std::iter::once(Cell::new(label)).chain(cells));
            }
        }
    }
    let mut text = format!("{}\n{}\n", table.title, grid.trim_fmt());
    for note in &table.notes {
        text.push_str("  ");
        text.push_str(note);
        text.push('\n');
    }
    text
}

/// Sets a table as HTML.
pub(super) fn markup(table: &Table) -> Markup {
    html! {
        figure.table {
            figcaption { (table.title) }
            table {
                thead {
                    tr {
                        @for (column, head) in table.head.iter().enumerate() {
                            @let prose = column > 0 && table.is_prose(column - 1);
                            th.prose[prose] scope="col" { (head) }
                        }
                    }
                }
                tbody {
                    @for row in &table.rows {
                        @match row {
                            Row::Group(name) => {
                                tr.group {
                                    th scope="rowgroup" colspan=(table.head.len()) { (name) }
                                }
                            }
                            Row::Values(label, cells) => {
                                tr {
                                    th scope="row" { (label_markup(label)) }
                                    @for (column, cell) in cells.iter().enumerate() {
                                        td.prose[table.is_prose(column)] { (cell) }
                                    }
                                }
                            }
                        }
                    }
                }
            }
            @for note in &table.notes { p.note { (note) } }
        }
    }
}

fn label_markup(label: &Label) -> Markup {
    match label {
        Label::Text(text) => html! { (text) },
        Label::Gene(gene) => {
            let (letter, index) = symbol(*gene);
            html! {
                span.symbol { i { (letter) } sub { (index) } } " " (meaning(*gene))
                " " span.id { (gene.as_str()) }
            }
        }
    }
}
