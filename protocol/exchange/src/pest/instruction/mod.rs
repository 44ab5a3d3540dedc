//! Instructions: where in a file the values of observations stand. Files are read forwards only.
mod list;
mod parse;
mod read;
#[cfg(test)]
mod tests;

pub use list::Instructions;

use crate::Problem;
use list::{Instruction, NOBODY};

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
