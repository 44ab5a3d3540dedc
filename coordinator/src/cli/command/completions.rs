//! `horsehead completions`: prints shell scripts that complete the commands and options of `horsehead`.
use crate::cli::output::{problem::EXIT_CODES, terminal};
use clap::{Args, Command};

/// Print a completion script for a shell.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Example:
  horsehead completions bash > ~/.local/share/bash-completion/completions/horsehead

{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// The shell.
    #[arg(value_enum)]
    shell: clap_complete::Shell,
}

pub(super) fn run(arguments: &Arguments, commands: &mut Command) -> anyhow::Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, commands, "horsehead", &mut script);
    terminal::write(&String::from_utf8(script)?)
}
