//! The parts of a report: sections, and the blocks that they are lists of.
use super::figure::Figure;
use super::table::Table;
use maud::Markup;

/// A whole report.
#[derive(Clone, Debug)]
pub struct Report {
    /// What it is about, as a title.
    pub title: String,
    /// Name of the run.
    pub run: String,
    /// The outcome in a word or two, first of all in plain text; empty where there is none.
    pub outcome: &'static str,
    /// Sections in the order of reading; those that have nothing to say are not among them.
    pub sections: Vec<Section>,
    /// Titles of those that have nothing to say.
    pub silent: Vec<&'static str>,
}

/// One section.
#[derive(Clone, Debug)]
pub struct Section {
    /// Anchor in the page.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// What stands below it, from top to bottom; empty where it has nothing to say.
    pub blocks: Vec<Block>,
}

/// A part of a section.
#[derive(Clone, Debug)]
pub enum Block {
    /// The sentence to read if only one is read.
    Lead(String),
    /// Heads the blocks that follow, with a remark that may be empty.
    Heading(String, &'static str),
    /// A paragraph.
    Text(String),
    /// Sentences side by side.
    List(Vec<String>),
    /// What must not be overlooked, a paragraph each.
    Warning(Vec<String>),
    /// Names with values.
    Facts(Vec<Fact>),
    /// Lines of a file.
    Code(String),
    /// A table.
    Table(Table),
    /// A figure: a picture in the page, and a file of its own.
    Figure(Figure),
    /// For the page alone: what moves, or what only leads to figures.
    Markup(Markup),
    /// Blocks that the page shows on demand, under a title.
    Folded(&'static str, Vec<Self>),
}

/// A name with its value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fact {
    /// What it is.
    pub name: String,
    /// What it is here.
    pub value: String,
    /// Whether the value is read by machines: a digest, a command.
    pub is_code: bool,
}

impl Fact {
    /// A fact in words.
    pub fn new(name: impl Into<String>, value: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            value: value.into(),
            is_code: false,
        }
    }

    /// A digest or a command.
    pub fn code(name: impl Into<String>, value: impl Into<String>) -> Self {
        Self {
            is_code: true,
            ..Self::new(name, value)
        }
    }
}

impl Report {
    /// A report from all sections that there could be: those without blocks are left out.
    pub fn new(title: String, run: &str, sections: impl IntoIterator<Item = Section>) -> Self {
        let sections = sections.into_iter();
        let (silent, sections): (Vec<_>, Vec<_>) = sections.partition(|one| one.blocks.is_empty());
        Self {
            title,
            run: run.to_owned(),
            outcome: "",
            sections,
            silent: silent.into_iter().map(|section| section.title).collect(),
        }
    }

    /// Every figure, in the order of the page.
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

/// Figures as blocks.
pub fn figures(all: impl IntoIterator<Item = Figure>) -> Vec<Block> {
    all.into_iter().map(Block::Figure).collect()
}

/// Tables as blocks.
pub fn tables(all: impl IntoIterator<Item = Table>) -> Vec<Block> {
    all.into_iter().map(Block::Table).collect()
}
