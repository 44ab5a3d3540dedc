//! Commands of `horsehead`, one per file.
//!
//! A command is a file with its `Arguments` and the function `run`; it is registered in this file by name in
//! the list of modules and in `commands!`. Its help shows examples and the exit codes, its options can also
//! be set by environment variables, and its results are printed through [`terminal`].
mod allow;
mod ask_tell;
mod bench;
mod calibrate;
mod case;
mod completions;
mod dashboard;
mod diagnose;
mod doctor;
#[cfg(test)]
mod documented_commands;
mod evaluate;
mod explain;
mod export;
mod identify;
mod keys;
mod report;
mod simulate;
mod sweep;
#[cfg(test)]
mod tests;
mod verify;
mod workers;

use super::output::{problem, terminal};
use crate::pumping_unit::{command as head, record};
use clap::{CommandFactory as _, Parser, Subcommand};
use std::process::ExitCode;

/// Makes a simulation agree with what was measured on the machine, and finds what it is missing.
#[derive(Debug, Parser)]
#[command(name = "horsehead", version, max_term_width = 100, after_help = FIRST_STEPS)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const FIRST_STEPS: &str = "\
First steps:
  horsehead case check cases/cyjs10-5-37hb
  horsehead simulate cases/cyjs10-5-37hb
  horsehead calibrate cases/cyjs10-5-37hb
  horsehead diagnose cases/cyjs10-5-37hb
  horsehead identify cases/cyjs10-5-37hb

Exit codes: 0 done, 1 failed, 2 usage or bad input, 130 interrupted.";

/// Defines the enum of the commands and its dispatch to their `run` functions; an expression in brackets is
/// passed to the command as an additional argument.
macro_rules! commands {
    ($($name:ident: $file:ident $([$more:expr])?,)*) => {
        #[derive(Debug, Subcommand)]
        enum Command {
            $($name(Box<$file::Arguments>),)*
        }

        impl Command {
            fn run(&self) -> anyhow::Result<()> {
                match self {
                    $(Self::$name(arguments) => $file::run(arguments $(, $more)?),)*
                }
            }
        }
    };
}

commands! {
    Simulate: simulate,
    Calibrate: calibrate,
    AskTell: ask_tell,
    Evaluate: evaluate,
    Sweep: sweep,
    Verify: verify,
    Diagnose: diagnose,
    Identify: identify,
    Head: head,
    Record: record,
    Dashboard: dashboard,
    Report: report,
    Explain: explain,
    Export: export,
    Case: case,
    Allow: allow,
    Keys: keys,
    Doctor: doctor,
    Workers: workers,
    Bench: bench,
    Completions: completions [&mut Cli::command()],
}

/// Runs the `horsehead` command given by the process arguments and returns its exit code.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => match problem::in_plain_words(&error.to_string()) {
            Some(text) if error.use_stderr() => {
                terminal::tell(text.trim_end());
                return ExitCode::from(problem::BAD_INPUT);
            }
            _ => error.exit(),
        },
    };
    terminal::diagnostics();
    match cli.command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => problem::explain(&error),
    }
}
