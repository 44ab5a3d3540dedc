//! Parts of a report: sections and the blocks that they consist of.
use super::figure::Figure;
use super::table::Table;
use maud::Markup;

/// Complete report, independent of the output format.
#[derive(Clone, Debug)]
pub struct Report {
    /// Title of the report.
    pub title: String,
    /// Name of the run whose results are reported.
    pub run: String,
    /// Outcome of the run in a word or two, printed first in plain text; empty where there is none.
    pub outcome: &'static str,
    /// Sections with content, in reading order.
    pub sections: Vec<Section>,
    /// Titles of the sections that were omitted because they have no blocks.
    pub omitted: Vec<&'static str>,
}

/// Section of a report.
#[derive(Clone, Debug)]
pub struct Section {
    /// Anchor of the section in the HTML page.
    pub id: &'static str,
    /// Heading of the section.
    pub title: &'static str,
    /// Content of the section, from top to bottom; empty where there are no data for the section.
    pub blocks: Vec<Block>,
}

/// Content element of a section: text, list, table, figure or markup.
#[derive(Clone, Debug)]
pub enum Block {
    /// Main sentence of the section.
    Lead(String),
    /// Heading of the blocks that follow, with a remark that may be empty.
    Heading(String, &'static str),
    /// Paragraph of running text.
    Text(String),
    /// Bullet list, one sentence per item.
    List(Vec<String>),
    /// Warning, one paragraph per item.
    Warning(Vec<String>),
    /// List of quantities with their values.
    Facts(Vec<Fact>),
    /// Code listing, e.g. lines of a file.
    Code(String),
    /// Table with numbers or text.
    Table(Table),
    /// Figure: an image in the page, and a separate SVG file.
    Figure(Figure),
    /// Markup for the HTML page only, e.g. an animation or links to figures.
    Markup(Markup),
    /// Script that moves the figures of the section, in the HTML page only and once in it. It adds functions to
    /// `horsehead.parts`, which are called with each new part of a page.
    Script(&'static str),
    /// Collapsible blocks under a title.
    Folded(&'static str, Vec<Self>),
}

/// Fact in a report: name of a quantity with its value as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fact {
    /// Name of the quantity.
    pub name: String,
    /// Value of the quantity as text.
    pub value: String,
    /// Whether the value is machine-readable (a digest, a command) and set as code.
    pub is_code: bool,
}

impl Fact {
    /// Creates a fact whose value is plain text.
    pub fn new(name: impl Into<String>, value: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            value: value.into(),
            is_code: false,
        }
    }

    /// Creates a fact whose value is machine-readable text such as a digest or a command.
    pub fn code(name: impl Into<String>, value: impl Into<String>) -> Self {
        Self {
            is_code: true,
            ..Self::new(name, value)
        }
    }
}

impl Report {
    /// Creates a report from all possible sections: sections without blocks are left out, and their titles
    /// are kept in `omitted`.
    pub fn new(title: String, run: &str, sections: impl IntoIterator<Item = Section>) -> Self {
        let sections = sections.into_iter();
        let (silent, sections): (Vec<_>, Vec<_>) = sections.partition(|one| one.blocks.is_empty());
        Self {
            title,
            run: run.to_owned(),
            outcome: "",
            sections,
            omitted: silent.into_iter().map(|section| section.title).collect(),
        }
    }

    /// Returns all figures in page order, including those in collapsible blocks.
    pub fn figures(&self) -> Vec<&Figure> {
        let mut figures = Vec::new();
        for section in &self.sections {
            gather(&section.blocks, &mut figures);
        }
        figures
    }
}

fn gather<'a>(blocks: &'a [Block], figures: &mut Vec<&'a Figure>) {
    for block in blocks {
        if let Block::Figure(figure) = block {
            figures.push(figure);
        } else if let Block::Folded(_, inner) = block {
            gather(inner, figures);
        }
    }
}

/// Returns the scripts of sections in page order, each once.
pub(super) fn scripts(sections: &[Section]) -> Vec<&'static str> {
    let blocks = sections.iter().flat_map(|section| &section.blocks);
    let mut scripts = Vec::new();
    for block in blocks {
        if let Block::Script(script) = block
            && !scripts.contains(script)
        {
            scripts.push(*script);
        }
    }
    scripts
}

/// Wraps each figure in a [`Block`], the content element of report sections.
pub fn figures(all: impl IntoIterator<Item = Figure>) -> Vec<Block> {
    all.into_iter().map(Block::Figure).collect()
}

/// Wraps each table in a [`Block`], the content element of report sections.
pub fn tables(all: impl IntoIterator<Item = Table>) -> Vec<Block> {
    all.into_iter().map(Block::Table).collect()
}
