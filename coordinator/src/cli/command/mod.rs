//! Commands of `horsehead`, one per file.
//!
//! A command is a file with its `Arguments` and the function `run`; it is registered in this file by name in
//! the list of modules and in `commands!`. Its help shows examples and the exit codes, its options can also
//! be set by environment variables, and its results are printed through [`terminal`].
mod allow;
mod ask_tell;
mod balance;
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
mod head;
mod identify;
mod keys;
mod life;
mod presets;
mod record;
mod report;
mod simulate;
mod sweep;
#[cfg(test)]
mod tests;
mod verify;
mod workers;

use super::output::{problem, terminal};
use clap::{Arg, ArgAction, CommandFactory as _, FromArgMatches as _, Parser, Subcommand};
use run::message;
use std::process::ExitCode;

/// Makes a simulation agree with what was measured on the machine, and finds what it is missing.
#[derive(Debug, Parser)]
#[command(name = "horsehead", version, max_term_width = 100)]
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

Every option can also be set by an environment variable, as HORSEHEAD_SEED for --seed.
Exit codes: 0 done, 1 failed, 2 usage or bad input, 130 interrupted.";

/// Commands by their use, in the order in which the help lists them.
const GROUPS: &[(&str, &[&str])] = &[
    (
        "Commands:",
        &[
            "case",
            "record",
            "head",
            "simulate",
            "calibrate",
            "presets",
            "verify",
            "diagnose",
            "identify",
            "life",
            "balance",
            "dashboard",
            "report",
            "export",
        ],
    ),
    (
        "For clusters:",
        &["sweep", "workers", "keys", "doctor", "explain", "bench"],
    ),
    (
        "For programs:",
        &["evaluate", "ask-tell", "allow", "completions"],
    ),
];

/// Builds the commands with their help: on the first level by their use, everywhere in two columns, without the
/// variables that set options, whose names follow from the options.
fn command() -> clap::Command {
    let command = with_plain_help(Cli::command());
    let group = |(title, names): &(&str, &[&str])| {
        let line = |name: &&str| {
            let about = command
                .find_subcommand(name)
                .and_then(clap::Command::get_about);
            format!("  {name:<12} {}\n", about.cloned().unwrap_or_default())
        };
        let lines: String = names.iter().map(line).collect();
        format!("{title}\n{lines}\n")
    };
    let list: String = GROUPS.iter().map(group).collect();
    command.help_template(format!(
        "{{about}}\n\n{{usage-heading}} {{usage}}\n\n{list}\
         Each command says more with --help.\n\n{FIRST_STEPS}\n"
    ))
}

/// Makes `--help` print what `-h` does, for a command and all below it.
fn with_plain_help(command: clap::Command) -> clap::Command {
    let help = Arg::new("help")
        .short('h')
        .long("help")
        .help("Print this help");
    command
        .disable_help_flag(true)
        .next_help_heading(None::<&str>)
        .arg(help.action(ArgAction::HelpShort))
        .mut_args(|arg| arg.hide_env(true))
        .mut_subcommands(with_plain_help)
}

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
    Presets: presets,
    Sweep: sweep,
    Verify: verify,
    Diagnose: diagnose,
    Identify: identify,
    Life: life,
    Balance: balance,
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
    Completions: completions [&mut command()],
}

/// Runs the `horsehead` command given by the process arguments and returns its exit code.
pub fn main() -> ExitCode {
    let parsed = command().try_get_matches();
    let cli = match parsed.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => match problem::in_plain_words(&error.to_string()) {
            Some(text) if error.use_stderr() => {
                message::print(text.trim_end());
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
