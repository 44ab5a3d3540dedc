//! Report of a diagnosis: one page with the verdict, the localisation of the residual, the candidate effects,
//! the added effects with their validation and certainty, and the provenance.
//!
//! All numbers are those of the diagnosis; only the paper's two error measures are computed here.
mod checks;
mod condition_curves;
mod csv;
mod effects;
mod judgement;
mod section;
mod subject;
mod table;
mod words;
mod write;

pub use checks::checks;
pub use effects::{effects, effects_toml, starts};
pub use subject::DiagnosisInput;
pub use write::{report, write};
