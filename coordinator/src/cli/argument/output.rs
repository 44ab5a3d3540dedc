//! Output format argument shared by all commands.
use clap::{Args, ValueEnum};

/// Format in which a command prints its results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Output {
    /// Tables for people.
    Table,
    /// One JSON object for programs.
    Json,
}

/// Output format argument, flattened into the arguments of every command.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct OutputChoice {
    /// How results are printed on standard output.
    #[arg(long, value_enum, default_value = "table", env = "HORSEHEAD_OUTPUT")]
    pub(crate) output: Output,
}
