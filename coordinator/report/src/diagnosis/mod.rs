//! What people see of a diagnosis: the argument from where to which effect, and the proof.
//!
//! One page that reads from top to bottom: the verdict, where the curves part, what was suspected,
//! what is added, what that shows, how sure it is, how it was made. Everything is the diagnosis' own
//! number: nothing is computed again here but the paper's two error measures.
mod csv;
mod effects;
mod judgement;
mod section;
mod shown;
mod subject;
mod table;
mod words;
mod write;

pub use effects::{effects, effects_toml, starts};
pub use subject::Subject;
pub use write::{report, write};
