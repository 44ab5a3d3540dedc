//! Control files: parameters, observations and files of a calibration, in PEST's two forms.
//!
//! In the older one numbers stand in their places and counts say how many lines there are; in the newer one (`*
//! control data keyword`) words say what is what and tables lie in files of their own. What PEST++ takes is taken;
//! what has no meaning here is listed in [`Control::notes`] and never dropped in silence.
mod check;
mod data;
mod lines;
mod prior;
mod rows;
mod said;
#[cfg(test)]
mod tests;

pub use said::{
    Control, IncrementKind, Method, Observation, Pair, Parameter, ParameterGroup, PriorInformation,
    PriorTerm, Transform,
};

use crate::Problem;

impl Control {
    /// Reads a control file; `open` gives the text of a file that it names, by the name that it uses.
    ///
    /// # Errors
    /// What cannot be read or contradicts itself, with file and line.
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
