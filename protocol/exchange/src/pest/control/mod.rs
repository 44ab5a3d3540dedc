//! Control files: parameters, observations and files of a calibration, in both of PEST's formats.
//!
//! In the older format numbers have fixed positions and counts state how many lines follow; in the newer one
//! (`* control data keyword`) keywords name the values and tables are stored in separate files. Everything
//! that PEST++ accepts is accepted; everything without a meaning here is listed in [`Control::notes`] and
//! never dropped silently.
mod check;
mod data;
mod lines;
mod model;
mod prior;
mod rows;
#[cfg(test)]
mod tests;

pub use model::{
    Control, FilePair, IncrementKind, LimitSide, Observation, Parameter, ParameterGroup,
    PriorInformation, PriorTerm, Transform,
};

use crate::Problem;

impl Control {
    /// Parses a control file; `open` returns the text of a file by the name used in the control file.
    ///
    /// # Errors
    /// Syntax errors and contradictions, with file and line.
    pub fn parse(
        file: &str,
        text: &str,
        open: &dyn Fn(&str) -> Result<String, String>,
    ) -> Result<Self, Problem> {
        let lines = lines::Lines::of(file, text)?;
        let mut control = data::read(&lines, open)?;
        check::check(file, &mut control)?;
        Ok(control)
    }
}
