//! Instructions: where in a file the values of observations stand. Files are read forwards only.
mod parse;
mod read;
#[cfg(test)]
mod tests;

use crate::Problem;

/// A list of instructions, read once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Instructions {
    file: String,
    lines: Vec<Line>,
}

/// The instructions that are carried out on one line of a file, unless one of them moves on.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Line {
    /// Where it begins in the list of instructions, from 1.
    number: usize,
    all: Vec<Instruction>,
}

/// One instruction; columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Instruction {
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
const NOBODY: &str = "dum";

impl Instructions {
    /// Reads instructions: `pif` and a delimiter in the first line, then lines of instructions.
    ///
    /// # Errors
    /// What is no instruction, a name that stands twice, with the line.
    pub fn parse(file: &str, text: &str) -> Result<Self, Problem> {
        parse::parse(file, text)
    }

    /// Names of the observations, in small letters, in the order in which they are read.
    pub fn observations(&self) -> Vec<String> {
        let all = self.lines.iter().flat_map(|line| &line.all);
        let named = all.filter_map(Instruction::observation);
        named
            .filter(|name| *name != NOBODY)
            .map(str::to_owned)
            .collect()
    }

    /// The values that a file holds; `read` is its name.
    ///
    /// # Errors
    /// A marker or line that is not there, what is no finite number, with the line of the instruction.
    pub fn read(&self, read: &str, text: &str) -> Result<Vec<(String, f64)>, Problem> {
        read::read(self, read, text)
    }
}

impl Instruction {
    fn observation(&self) -> Option<&str> {
        match self {
            Self::Fixed(name, ..) | Self::SemiFixed(name, ..) | Self::Free(name) => Some(name),
            Self::Marker(_) | Self::Lines(_) | Self::Word | Self::Tab(_) => None,
        }
    }
}
