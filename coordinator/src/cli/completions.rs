//! `horsehead completions`: scripts that let a shell complete commands and options.
use super::{Cli, EXIT_CODES, output};
use clap::{Args, CommandFactory as _};

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

/// Prints the script.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(
        arguments.shell,
        &mut Cli::command(),
        "horsehead",
        &mut script,
    );
    output::write(&String::from_utf8(script)?)
}
