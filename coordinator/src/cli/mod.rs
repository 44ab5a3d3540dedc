//! The command line: what is typed, what is printed, and the runs in between.
//!
//! `command` has one command per file over the `argument`s that several share; `run` begins,
//! resumes and repeats runs of either kind, and holds their folders; `output` makes tables, files
//! and JSON objects of what was found. Results go to standard output, everything else to standard
//! error. `--output json` prints exactly one object.
pub(crate) mod argument;
mod command;
pub(crate) mod output;
pub(crate) mod run;

pub use command::main;
