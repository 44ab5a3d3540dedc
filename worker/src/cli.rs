//! The command line of `horsehead-worker`.
use crate::external::start::Start;
use clap::{Parser, Subcommand};
use link::locator::Locator;
use std::path::PathBuf;

/// Address space of a slot's process by default (MiB): a simulation needs some tens, the reduction
/// of a large head some thousand.
pub const SLOT_MEMORY_MIB: u64 = 8192;

/// Computes simulations for a Horsehead coordinator.
///
/// Start any number of workers, before or after the coordinator, and stop them whenever you like:
/// what they hold is computed by others. A worker stays when the coordinator goes away and
/// returns what it finished meanwhile; it keeps no files.
#[derive(Clone, Debug, Parser)]
#[command(
    name = "horsehead-worker",
    version,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "Examples:\n  \
        horsehead-worker --connect tcp/127.0.0.1:7447\n  \
        horsehead-worker --connect quic/head.example:7447 --tls worker-01 --idle-timeout 600\n\n\
        Exit status: 0 ended in good order, 1 could not work, 2 wrong command line, \
        3 refused by the coordinator, or certificates that do not fit.\n\
        HORSEHEAD_LOG sets what is logged, as in \"debug\" or \"worker=debug\"."
)]
pub struct Cli {
    /// Address of the coordinator: tcp/HOST:PORT, or quic/HOST:PORT with certificates
    #[arg(
        long,
        value_name = "LOCATOR",
        env = "HORSEHEAD_CONNECT",
        required = true,
        value_parser = Locator::parse
    )]
    pub connect: Option<Locator>,
    /// Folder with this worker's certificate, for quic/ addresses: `horsehead keys new` makes it
    #[arg(long, value_name = "DIR", env = link::keys::FOLDER_VARIABLE)]
    pub tls: Option<PathBuf>,
    /// Simulations computed at a time [default: one per hardware thread]
    #[arg(long, value_name = "N", env = "HORSEHEAD_SLOTS", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub slots: Option<u16>,
    /// End after so long without work [default: never]
    #[arg(long, value_name = "SECONDS", env = "HORSEHEAD_IDLE_TIMEOUT", value_parser = clap::value_parser!(u64).range(1..))]
    pub idle_timeout: Option<u64>,
    /// Address space that one simulation may have \[MiB\]; 0 for no limit. What needs more is
    /// ended and counts as crashed
    #[arg(long, value_name = "MIB", env = "HORSEHEAD_SLOT_MEMORY", default_value_t = SLOT_MEMORY_MIB)]
    pub slot_memory: u64,
    /// Belong to the process that started this one: end with it and with its run
    #[arg(long, hide = true)]
    pub embedded: bool,
    /// What else this program can be
    #[command(subcommand)]
    pub role: Option<Role>,
}

/// Roles that only the program itself uses.
#[derive(Clone, Debug, Subcommand)]
pub enum Role {
    /// Compute what standard input says
    #[command(hide = true)]
    Slot {
        /// Address space it may have \[MiB\]; 0 for no limit
        #[arg(long, default_value_t = 0)]
        memory: u64,
    },
    /// Become a program of this machine's list, within its limits
    #[command(hide = true)]
    Start(Start),
}
