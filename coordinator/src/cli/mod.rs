//! Command line: arguments, runs and output.
//!
//! `command` has one command per file and uses the `argument`s that several commands share; `run` begins,
//! resumes and reads runs of every kind and manages their folders; `dashboard` follows runs and shows them in a
//! browser; `output` formats results as tables, files and JSON objects. Results go to standard output, everything else to standard error. `--output json`
//! prints exactly one object.
pub(crate) mod argument;
mod command;
mod dashboard;
pub(crate) mod output;
pub(crate) mod run;

pub use command::main;
