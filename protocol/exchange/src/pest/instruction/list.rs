//! Parsed instructions of a PEST instruction file.

/// Parsed instruction file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Instructions {
    pub(super) file: String,
    pub(super) lines: Vec<Line>,
}

/// Instructions applied to one line of the file that is read, unless an instruction advances to a later line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Line {
    /// Line number in the instruction file, from 1.
    pub(super) number: usize,
    pub(super) all: Vec<Instruction>,
}

/// Single instruction; columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Instruction {
    /// Search for a text: as the first instruction in the following lines, otherwise in the rest of the
    /// current line.
    Marker(String),
    /// Advance by a number of lines.
    Lines(usize),
    /// Advance to the last blank before the next word.
    Word,
    /// Advance to a column.
    Tab(usize),
    /// Number that lies between two columns, with the name of its observation.
    Fixed(String, usize, usize),
    /// Number that overlaps the range between two columns, with the name of its observation.
    SemiFixed(String, usize, usize),
    /// Next number in the line, with the name of its observation.
    Free(String),
}

/// Observation name whose value is read and discarded.
pub(super) const NOBODY: &str = "dum";

impl Instruction {
    /// Returns the name of the observation that the instruction reads, if any.
    pub(super) fn observation(&self) -> Option<&str> {
        match self {
            Self::Fixed(name, ..) | Self::SemiFixed(name, ..) | Self::Free(name) => Some(name),
            Self::Marker(_) | Self::Lines(_) | Self::Word | Self::Tab(_) => None,
        }
    }
}
