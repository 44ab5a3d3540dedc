//! `horsehead sweep`: many searches, or many individuals, in one resumable run.
mod orthogonal;

use clap::{Args, Subcommand};

/// Compare settings of a search, or score a table of individuals.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    kind: Kind,
}

#[derive(Debug, Subcommand)]
enum Kind {
    Orthogonal(orthogonal::Arguments),
}

/// Sweeps.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.kind {
        Kind::Orthogonal(arguments) => orthogonal::run(arguments),
    }
}
