//! `horsehead workers`: starts workers on other nodes, and lists, drains or ends those of a run.
use crate::cli::output::problem::EXIT_CODES;
use clap::{Args, Subcommand};

mod control;
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
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", control::LIST))]
    List(control::ListArguments),
    /// Give workers no more jobs.
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", control::DRAIN))]
    Drain(control::DrainArguments),
    /// End workers.
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", control::DOWN))]
    Down(control::DownArguments),
    /// Show the last lines of the log of a host's workers.
    #[command(after_help = format!("{}\n\n{EXIT_CODES}", up::LOGS))]
    Logs(up::LogsArguments),
}

/// Runs the selected action of `horsehead workers`: up, list, drain, down or logs.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.action {
        Action::Up(arguments) => up::run(arguments),
        Action::List(arguments) => control::list(arguments),
        Action::Drain(arguments) => control::drain(arguments),
        Action::Down(arguments) => control::down(arguments),
        Action::Logs(arguments) => up::logs(arguments),
    }
}
