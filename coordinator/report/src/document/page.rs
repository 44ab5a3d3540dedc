//! HTML output: one self-contained, printable file without external resources.
use super::block::{Block, Fact, Report, Section, scripts};
use super::figure::Figure;
use super::table::{Label, Row, Table};
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// Style sheet of every page, for light and dark screens, phones and print.
pub const STYLE: &str = include_str!("style.css");

/// Tag by which a page is recognised as one of this program.
pub const GENERATOR: &str = r#"<meta name="generator" content="Horsehead">"#;

/// Script of every page: sorts and filters tables, and replaces sections in the pages of a dashboard.
pub(crate) const SCRIPT: &str = include_str!("page.js");

/// Renders a report as an HTML page with its scripts.
pub fn page(report: &Report) -> String {
    let (title, run) = (&report.title, &report.run);
    let page: Markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="generator" content="Horsehead";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    p.kind { "Horsehead" @if !run.is_empty() { " · " (run) } }
                    h1 { (title) }
                    nav {
                        @for section in &report.sections {
                            a href=(format!("#{}", section.id)) { (section.title) }
                        }
                    }
                }
                main {
                    @for section in &report.sections { (section_markup(section)) }
                }
                script {
                    (PreEscaped("/*<![CDATA[*/\n"))
                    (PreEscaped(SCRIPT))
                    @for script in scripts(&report.sections) { (PreEscaped(script)) }
                    (PreEscaped("/*]]>*/"))
                }
            }
        }
    };
    page.into_string()
}

/// Renders a section as an HTML element.
pub fn section_markup(section: &Section) -> Markup {
    html! {
        section id=(section.id) {
            h2 { (section.title) }
            @for block in &section.blocks { (markup(block)) }
        }
    }
}

/// Renders a sentence; words between backticks become code.
pub(super) fn sentence(text: &str) -> Markup {
    let parts: Vec<&str> = text.split('`').collect();
    // a last backtick without another one stands for itself
    let whole = if parts.len() % 2 == 1 {
        parts.len()
    } else {
        parts.len() - 2
    };
    html! {
        @for (place, part) in parts[..whole].iter().enumerate() {
            @if place % 2 == 1 { code { (part) } } @else { (part) }
        }
        @if whole < parts.len() { (parts[whole..].join("`")) }
    }
}

fn markup(block: &Block) -> Markup {
    match block {
        Block::Lead(text) => html! { p.verdict { (sentence(text)) } },
        Block::Heading(text, remark) => html! {
            h3 { (text) @if !remark.is_empty() { span.role { (remark) } } }
        },
        Block::Text(text) => html! { p { (sentence(text)) } },
        Block::List(items) => html! { ul { @for item in items { li { (sentence(item)) } } } },
        Block::Warning(all) => html! { div.warning { @for one in all { p { (sentence(one)) } } } },
        Block::Facts(facts) => html! { dl.facts { @for fact in facts { (fact_markup(fact)) } } },
        Block::Code(lines) => html! { pre { code { (lines) } } },
        Block::Table(table) => table_markup(table),
        Block::Figure(figure) => figure_markup(figure),
        Block::Markup(markup) => markup.clone(),
        // stands at the end of the page
        Block::Script(_) => html! {},
        Block::Folded(title, blocks) => html! {
            details {
                summary { (title) }
                @for block in blocks { (markup(block)) }
            }
        },
    }
}

fn fact_markup(fact: &Fact) -> Markup {
    html! {
        dt { (fact.name) }
        dd { @if fact.is_code { code { (fact.value) } } @else { (fact.value) } }
    }
}

fn figure_markup(figure: &Figure) -> Markup {
    html! {
        figure id=(format!("figure-{}", figure.name)) {
            div.scroll { (PreEscaped(&figure.svg)) }
            figcaption { (sentence(&figure.caption)) }
        }
    }
}

fn table_markup(table: &Table) -> Markup {
    html! {
        figure.table {
            figcaption { (table.title) }
            div.scroll {
                table {
                    thead {
                        tr {
                            @for (column, head) in table.head.iter().enumerate() {
                                @let prose = column > 0 && table.is_prose(column - 1);
                                th.prose[prose] scope="col" { (head) }
                            }
                        }
                    }
                    tbody { @for row in &table.rows { (row_markup(table, row)) } }
                }
            }
            @for note in &table.notes { p.note { (sentence(note)) } }
        }
    }
}

fn row_markup(table: &Table, row: &Row) -> Markup {
    match row {
        Row::Group(name) => html! {
            tr.group { th scope="rowgroup" colspan=(table.head.len()) { (name) } }
        },
        Row::Values(label, cells) => html! {
            tr {
                th scope="row" { (label_markup(label)) }
                @for (column, cell) in cells.iter().enumerate() {
                    td.prose[table.is_prose(column)] { (cell) }
                }
            }
        },
    }
}

fn label_markup(label: &Label) -> Markup {
    match label {
        Label::Text(text) => html! { (text) },
        Label::Unknown {
            name,
            title,
            symbol,
        } => {
            let (letter, index) = symbol.split_once('_').unwrap_or((symbol, ""));
            html! {
                @if symbol != name { span.symbol { i { (letter) } sub { (index) } } " " }
                (title) " " span.id { (name) }
            }
        }
    }
}
