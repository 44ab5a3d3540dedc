//! Plain-text output for the terminal and for `tables.txt`: the whole report without its images.
use super::block::{Block, Report, Section};
use super::table::{Label, Row, Table};
use comfy_table::{
    Cell, CellAlignment, ColumnConstraint, ContentArrangement, LineStyle, Width, presets,
};

/// Capabilities of the terminal or file for which text is rendered; by default those of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TerminalStyle {
    /// Whether heads and group names of tables are set in bold by escape sequences.
    pub bold: bool,
    /// Number of columns into which tables are fitted by wrapping their cells; `None` for as many as they need.
    pub width: Option<u16>,
}

/// Renders the whole report as text.
pub fn text(report: &Report, style: TerminalStyle) -> String {
    let mut whole = String::from(report.outcome);
    if !whole.is_empty() {
        whole.push('\n');
    }
    for (index, section) in report.sections.iter().enumerate() {
        let body = section_text(section, style);
        // the first section needs no heading: what it says is what the report says
        if index > 0 && !body.is_empty() {
            whole += &["\n", &section.title.to_uppercase(), "\n"].concat();
        }
        whole += &body;
    }
    whole
}

/// Renders the blocks of one section, without its heading.
pub(crate) fn section_text(section: &Section, style: TerminalStyle) -> String {
    all(&section.blocks, style)
}

/// Renders blocks one below the other, with an empty line before headings, code, tables and collapsible
/// blocks.
fn all(blocks: &[Block], style: TerminalStyle) -> String {
    let mut text = String::new();
    for block in blocks {
        let apart = matches!(
            block,
            Block::Heading(..) | Block::Code(_) | Block::Table(_) | Block::Folded(..)
        );
        let own = one(block, style);
        if apart && !text.is_empty() && !own.is_empty() {
            text.push('\n');
        }
        text += &own;
    }
    text
}

fn one(block: &Block, style: TerminalStyle) -> String {
    match block {
        Block::Lead(line) | Block::Text(line) | Block::Code(line) | Block::Heading(line, "") => {
            format!("{line}\n")
        }
        Block::Heading(heading, remark) => format!("{heading} ({remark})\n"),
        Block::List(lines) => items(lines, "  - "),
        Block::Warning(lines) => items(lines, "  ! "),
        Block::Facts(facts) => {
            let facts = facts.iter();
            let lines = facts.map(|fact| format!("{}: {}", fact.name, fact.value));
            items(&lines.collect::<Vec<_>>(), "  ")
        }
        Block::Table(table) => set_table(table, style),
        Block::Folded(_, blocks) => all(blocks, style),
        Block::Figure(_) | Block::Markup(_) | Block::Script(_) => String::new(),
    }
}

/// Prefixes each line with the given mark, such as a bullet.
fn items(lines: &[String], mark: &str) -> String {
    let lines = lines.iter().map(|line| [mark, line, "\n"].concat());
    lines.collect()
}

/// Width of the space on both sides of a cell's content (columns).
const PADDING: u16 = 2;

/// Renders a table with its title and notes.
pub fn set_table(table: &Table, style: TerminalStyle) -> String {
    let alignment = |column: usize| {
        if table.is_prose(column) {
            CellAlignment::Left
        } else {
            CellAlignment::Right
        }
    };
    let mut grid = comfy_table::Table::new();
    if let Some(width) = style.width {
        grid.set_content_arrangement(ContentArrangement::Dynamic);
        grid.set_width(width);
    }
    // rules above, below and under the head only, as in print
    grid.load_style(presets::UTF8_HORIZONTAL_ONLY.row_separator(LineStyle::none()));
    grid.set_header(table.head.iter().enumerate().map(|(column, head)| {
        let alignment = column.checked_sub(1).map_or(CellAlignment::Left, alignment);
        Cell::new(head).set_alignment(alignment)
    }));
    for row in &table.rows {
        match row {
            Row::Group(name) => {
                grid.add_row(vec![Cell::new(name)]);
            }
            Row::Values(label, cells) => {
                let label = match label {
                    Label::Text(text) => format!("  {text}"),
                    Label::Unknown { name, title, .. } => format!("  {name:<5} {title}"),
                };
                // wrapping would take away the spaces in front
                let label = match (style.width, label.strip_prefix("  ")) {
                    (Some(_), Some(rest)) => format!("\u{a0}\u{a0}{rest}"),
                    _ => label,
                };
                let cells = cells.iter().enumerate();
                let cells =
                    cells.map(|(column, cell)| Cell::new(cell).set_alignment(alignment(column)));
                grid.add_row(std::iter::once(Cell::new(label)).chain(cells));
            }
        }
    }
    if style.width.is_some() {
        let columns = grid.column_iter_mut().skip(1).enumerate();
        for (column, own) in columns.filter(|(column, _)| !table.is_prose(*column)) {
            // a number is not broken; a head may be
            let width = Width::Fixed(table.widest_cell(column) + PADDING);
            own.set_constraint(ColumnConstraint::LowerBoundary(width));
        }
    }
    let notes = items(&table.notes, "  ");
    let grid = grid.trim_fmt();
    let grid = if style.bold {
        bold_heads(&grid, table)
    } else {
        grid
    };
    format!("{}\n{grid}\n{notes}", table.title)
}

/// Sets the head and the group names of a rendered table in bold, for a terminal.
fn bold_heads(grid: &str, table: &Table) -> String {
    let is_group = |line: &str| {
        let mut groups = table.rows.iter().filter_map(|row| match row {
            Row::Group(name) => Some(name.as_str()),
            Row::Values(..) => None,
        });
        groups.any(|name| name == line.trim())
    };
    // the head stands between the first rule and the second
    let mut rules = 0;
    let lines = grid.lines().map(|line| {
        let is_rule = line.starts_with(['─', '═']);
        rules += usize::from(is_rule);
        if !is_rule && (rules == 1 || is_group(line)) {
            format!("\x1b[1m{line}\x1b[0m")
        } else {
            line.to_owned()
        }
    });
    lines.collect::<Vec<_>>().join("\n")
}
