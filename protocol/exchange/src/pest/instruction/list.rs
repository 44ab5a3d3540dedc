//! Instructions as they were read.

/// A list of instructions, read once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Instructions {
    pub(super) file: String,
    pub(super) lines: Vec<Line>,
}

/// The instructions that are carried out on one line of a file, unless one of them moves on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Line {
    /// Where it begins in the list of instructions, from 1.
    pub(super) number: usize,
    pub(super) all: Vec<Instruction>,
}

/// One instruction; columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Instruction {
    /// A text that is looked for: in the lines that follow where it stands first, else further on in this line.
    Marker(String),
    /// So many lines on.
    Lines(usize),
    /// On to the last blank before the next word.
    Word,
    /// To a column.
    Tab(usize),
    /// A number between two columns.
    Fixed(String, usize, usize),
    /// A number of which some part stands between two columns.
    SemiFixed(String, usize, usize),
    /// The next number.
    Free(String),
}

/// An observation of this name is read and not kept.
pub(super) const NOBODY: &str = "dum";

impl Instruction {
    /// Name of the observation that it reads.
    pub(super) fn observation(&self) -> Option<&str> {
        match self {
            Self::Fixed(name, ..) | Self::SemiFixed(name, ..) | Self::Free(name) => Some(name),
            Self::Marker(_) | Self::Lines(_) | Self::Word | Self::Tab(_) => None,
        }
    }
}
