//! Parsed instructions of a PEST instruction file.

/// Parsed PEST instruction file, by which observations are read from a model output file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Instructions {
    pub(super) file: String,
    pub(super) lines: Vec<Line>,
}

/// Line of an instruction file: instructions applied to one line of the model output file, unless one of them
/// advances to a later line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Line {
    pub(super) number: usize,
    pub(super) all: Vec<Instruction>,
}

/// Single instruction for reading a model output file; columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Instruction {
    /// Search for a text: in the following lines if it is the first instruction, otherwise in the rest of the
    /// current line.
    Marker(String),
    /// Advance by a number of lines.
    Lines(usize),
    /// Advance to the last blank before the next word of the current line.
    Word,
    /// Advance to a column of the current line.
    Tab(usize),
    /// Read the number that lies exactly between two columns, for the named observation.
    Fixed(String, usize, usize),
    /// Read the whole number, of any length, that overlaps the range between two columns, for the named
    /// observation.
    SemiFixed(String, usize, usize),
    /// Read the next number in the line, for the named observation.
    Free(String),
}

/// Observation name whose value is read and discarded.
pub(super) const DUMMY: &str = "dum";

impl Instruction {
    /// Returns the name of the observation that the instruction reads, if any.
    pub(super) fn observation(&self) -> Option<&str> {
        match self {
            Self::Fixed(name, ..) | Self::SemiFixed(name, ..) | Self::Free(name) => Some(name),
            Self::Marker(_) | Self::Lines(_) | Self::Word | Self::Tab(_) => None,
        }
    }
}
