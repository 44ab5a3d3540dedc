//! PEST instruction files: positions of observations in a model output file, which is read forwards only.
mod list;
mod parse;
mod read;
#[cfg(test)]
mod tests;

pub use list::Instructions;

use crate::Problem;
use list::{DUMMY, Instruction};

impl Instructions {
    /// Parses an instruction file: `pif` and a delimiter in the first line, then lines of instructions.
    ///
    /// # Errors
    /// An invalid instruction or a duplicate observation name, with the line.
    pub fn parse(file: &str, text: &str) -> Result<Self, Problem> {
        parse::parse(file, text)
    }

    /// Returns the names of the observations in lower case, in the order in which they are read.
    pub fn observations(&self) -> Vec<String> {
        let all = self.lines.iter().flat_map(|line| &line.all);
        let named = all.filter_map(Instruction::observation);
        named
            .filter(|name| *name != DUMMY)
            .map(str::to_owned)
            .collect()
    }

    /// Reads the values of all observations from a file's text; `read` is the file's name.
    ///
    /// # Errors
    /// A marker or line that does not exist, or a number that is not finite, with the line of the
    /// instruction.
    pub fn read(&self, read: &str, text: &str) -> Result<Vec<(String, f64)>, Problem> {
        read::read(self, read, text)
    }
}
