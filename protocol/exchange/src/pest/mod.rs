//! Files of PEST: templates that are filled in, instructions that find values, control files.
//!
//! Source: PEST++ user's manual, chapters 2 (templates, instructions) and 4 (control files). Names are in small
//! letters, for they are the same in any case.
mod control;
mod digits;
mod instruction;
mod mark;
mod report;
mod template;

pub use control::{
    Control, IncrementKind, Method, Observation, Pair, Parameter, ParameterGroup, PriorInformation,
    PriorTerm, Transform,
};
pub use digits::fit;
pub use instruction::Instructions;
pub use report::{ParRow, ReiRow, par, rei};
pub use template::Template;
