//! Developers' measurements of the dynamics: accuracy against work for each time integration method, and
//! verdicts of individuals over the whole search box.
//!
//! Simulates in this process with the worker's handlers; knows nothing of the bus, of searches and of
//! reports. `--help` of a command has examples.
mod figure;
mod integrators;
mod machine;
mod output;
mod verdicts;
mod whole_box;
mod work;

use clap::{Parser, Subcommand};

/// Measure the cost of accuracy and the verdicts over the search box.
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
}

fn main() -> anyhow::Result<()> {
    match Cli::parse().command {
        Command::Integrators(arguments) => integrators::run(&arguments),
        Command::Box(arguments) => whole_box::run(&arguments),
    }
}
