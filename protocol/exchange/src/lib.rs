//! Files that other people's programs read and write, in the forms in which people have them: PEST's templates,
//! instructions and control files, Dakota's parameters and results, tables, JSON. And what a machine allows to be
//! started ([`allow`]).
//!
//! All but that list are functions of text. Nothing here knows a case, a search or a process.
pub mod allow;
pub mod dakota;
mod number;
pub mod object;
pub mod pest;
mod problem;
pub mod table;

pub use number::number;
pub use problem::Problem;
