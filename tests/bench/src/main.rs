//! Developers' measurements: accuracy against work for each time integration method, verdicts of individuals over the
//! whole search box, dispatch of empty jobs to many sessions, and searches on more slots than there are.
//!
//! `--help` of a command has examples.
mod dispatch;
mod figure;
mod integrators;
mod machine;
mod output;
mod scaling;
mod verdicts;
mod whole_box;
mod window;
mod work;

use clap::{Parser, Subcommand};

/// Measure the cost of accuracy, verdicts over the search box, dispatch, and scaling.
#[derive(Debug, Parser)]
#[command(name = "bench", max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Integrators(integrators::Arguments),
    Box(whole_box::Arguments),
    Dispatch(dispatch::Arguments),
    Scaling(scaling::Arguments),
    Window(window::Arguments),
    #[command(subcommand, hide = true)]
    Peers(dispatch::Peers),
}

fn main() -> anyhow::Result<()> {
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_env_filter("warn,zenoh=off")
        .init();
    match Cli::parse().command {
        Command::Integrators(arguments) => integrators::run(&arguments),
        Command::Box(arguments) => whole_box::run(&arguments),
        Command::Dispatch(arguments) => dispatch::run(&arguments),
        Command::Scaling(arguments) => scaling::run(&arguments),
        Command::Window(arguments) => window::run(&arguments),
        Command::Peers(peers) => dispatch::serve(&peers),
    }
}
