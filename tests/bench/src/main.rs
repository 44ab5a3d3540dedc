//! What developers measure of the dynamics: accuracy against work by method of integration, and how
//! individuals end all over the box of genes.
//!
//! Simulates in this process by the worker's own handlers; knows nothing of the bus, of searches and
//! of reports. `--help` of a command has examples.
mod figure;
mod integrators;
mod machine;
mod output;
mod verdicts;
mod whole_box;
mod work;

use clap::{Parser, Subcommand};

/// Measures what accuracy costs, and what a search may meet.
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
