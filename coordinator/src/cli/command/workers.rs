//! `horsehead workers`: bring workers up on other nodes, and see to those that are there.
use crate::cli::output::problem::EXIT_CODES;
use clap::{Args, Subcommand};

mod crew;
mod up;

/// Bring workers up on spare nodes, and see to those of a run.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Start workers on other nodes, by ssh, Slurm, Kubernetes or this machine's systemd.
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", up::EXAMPLES))]
    Up(Box<up::Arguments>),
    /// Show who works on a run: name, host, slots, version, jobs in hand, rate, last seen.
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", crew::LIST))]
    List(crew::ListArguments),
    /// Give workers no more jobs.
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", crew::DRAIN))]
    Drain(crew::DrainArguments),
    /// End workers.
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", crew::DOWN))]
    Down(crew::DownArguments),
    /// Show the end of what a host's workers said.
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", up::LOGS))]
    Logs(up::LogsArguments),
}

/// Does it.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.action {
        Action::Up(arguments) => up::run(arguments),
        Action::List(arguments) => crew::list(arguments),
        Action::Drain(arguments) => crew::drain(arguments),
        Action::Down(arguments) => crew::down(arguments),
        Action::Logs(arguments) => up::logs(arguments),
    }
}
