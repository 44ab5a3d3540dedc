//! Orthogonal tests of several factors at once: which level of which factor is best, and whether the record of
//! runs can tell.
//!
//! Pure functions of plain data. It knows neither what a factor does, nor who runs anything.
//! Source: D. C. Montgomery, Design and Analysis of Experiments, chapters 3 and 4.
mod anova;
mod array;
mod range;
mod tested;

pub use anova::{Anova, Source, Term, anova};
pub use array::Array;
pub use range::{Observation, Range, predicted, ranges};
pub use tested::{Analysis, Confirmation, Factor, Tested, Tried};
