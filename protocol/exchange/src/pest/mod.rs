//! PEST's files: templates, instruction files that locate values, and control files.
//!
//! Source: PEST++ user's manual, chapters 2 (templates, instructions) and 4 (control files). Names are
//! converted to lower case, because PEST ignores case.
mod control;
mod digits;
mod first_line;
mod instruction;
mod jacobian;
mod report;
mod template;

pub use control::{
    Control, FilePair, IncrementKind, LimitSide, Observation, Parameter, ParameterGroup,
    PriorInformation, PriorTerm, Transform,
};
pub use digits::fit;
pub use instruction::Instructions;
pub use jacobian::jacobian;
pub use report::{ParRow, ReiRow, par, rei};
pub use template::{Template, TemplateField};
