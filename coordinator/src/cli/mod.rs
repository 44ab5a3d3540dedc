//! Command line: arguments, commands and output.
//!
//! `command` has one command per file and uses the `argument`s that several commands share; `output` formats results as
//! tables, files and JSON objects. Results go to standard output, everything else to standard error. `--output json`
//! prints exactly one object.
pub(crate) mod argument;
mod command;
pub(crate) mod output;

pub use command::main;
