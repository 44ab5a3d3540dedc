//! Readers and writers for the files of external programs: PEST's templates, instructions and control files,
//! Dakota's parameters and results, tables, JSON. Also the list of programs that a machine allows to be
//! started ([`allow`]).
//!
//! Everything except [`allow`] is a pure function of text. This crate has no knowledge of cases, searches or
//! processes.
pub mod allow;
pub mod dakota;
mod number;
pub mod object;
pub mod pest;
mod problem;
pub mod table;
mod text;

pub use number::number;
pub use problem::Problem;
pub use text::{decoded, is_utf16, utf8_or_latin1};
