//! `horsehead workers`: starts workers on other nodes, and lists, drains or ends those of a run.
use crate::cli::output::problem::EXIT_CODES;
use clap::{Args, Subcommand};

mod crew;
mod up;

/// Start workers on spare nodes, and manage those of a run.
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
    /// Show the workers of a run: name, host, slots, version, jobs in hand, rate, last seen.
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", crew::LIST))]
    List(crew::ListArguments),
    /// Give workers no more jobs.
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", crew::DRAIN))]
    Drain(crew::DrainArguments),
    /// End workers.
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", crew::DOWN))]
    Down(crew::DownArguments),
    /// Show the last lines of the log of a host's workers.
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", up::LOGS))]
    Logs(up::LogsArguments),
}

/// Runs the selected action.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.action {
        Action::Up(arguments) => up::run(arguments),
        Action::List(arguments) => crew::list(arguments),
        Action::Drain(arguments) => crew::drain(arguments),
        Action::Down(arguments) => crew::down(arguments),
        Action::Logs(arguments) => up::logs(arguments),
    }
}
