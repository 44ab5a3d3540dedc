//! Orthogonal tests of several factors at once: the best level of each factor, and whether its effect is
//! statistically significant.
//!
//! Pure functions of plain data, independent of the meaning of the factors and of the execution of the runs.
//! Source: D. C. Montgomery, Design and Analysis of Experiments, chapters 3 and 4.
mod anova;
mod array;
mod outcome;
mod range;

pub use anova::{Anova, AnovaTerm, VarianceSource, anova};
pub use array::Array;
pub use outcome::{Analysis, Confirmation, Factor, TestResult, TrialRun};
pub use range::{Range, Response, predicted, ranges};
