//! The choice of output.
use clap::{Args, ValueEnum};

/// How results are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Output {
    /// Tables for people.
    Table,
    /// One JSON object for programs.
    Json,
}

/// The choice of output, shared by all commands.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct OutputChoice {
    /// How results are printed on standard output.
    #[arg(long, value_enum, default_value = "table", env = "HORSEHEAD_OUTPUT")]
    pub(crate) output: Output,
}
