//! Command line of `horsehead-worker`.
use crate::external::start::Start;
use clap::{Parser, Subcommand};
use link::locator::Locator;
use std::path::PathBuf;

/// Default address space of a slot's process (MiB): a simulation needs some tens, the reduction of a large
/// head some thousand.
pub const SLOT_MEMORY_MIB: u64 = 8192;

/// Computes simulations for a Horsehead coordinator.
///
/// Start any number of workers, before or after the coordinator, and stop them at any time: their unfinished
/// jobs go to other workers. A worker keeps running while the coordinator is away and delivers its finished
/// results afterwards; it keeps no files.
#[derive(Clone, Debug, Parser)]
#[command(
    name = "horsehead-worker",
    version,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "Examples:\n  \
        horsehead-worker --connect unix/sockets/bus\n  \
        horsehead-worker --connect quic/head.example:7447 --tls worker-01 --idle-timeout 600\n\n\
        Exit status: 0 ended normally, 1 could not work, 2 wrong command line, \
        3 refused by the coordinator, or certificates that do not fit.\n\
        HORSEHEAD_LOG sets what is logged, as in \"debug\" or \"worker=debug\"."
)]
pub struct Cli {
    /// Address of the coordinator: quic/HOST:PORT with certificates, or unix/PATH on this machine
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
    /// Idle time after which the worker ends [default: never]
    #[arg(long, value_name = "SECONDS", env = "HORSEHEAD_IDLE_TIMEOUT", value_parser = clap::value_parser!(u64).range(1..))]
    pub idle_timeout: Option<u64>,
    /// Address space of one simulation \[MiB\]; 0 for no limit. A simulation that needs more is ended and
    /// counts as crashed
    #[arg(long, value_name = "MIB", env = "HORSEHEAD_SLOT_MEMORY", default_value_t = SLOT_MEMORY_MIB)]
    pub slot_memory: u64,
    /// File in which the worker states whether it takes part in a run, replaced at each change
    #[arg(long, value_name = "FILE")]
    pub status: Option<PathBuf>,
    /// Belong to the process that started this worker: end with that process and with its run
    #[arg(long, hide = true)]
    pub embedded: bool,
    /// Internal subcommands
    #[command(subcommand)]
    pub role: Option<ProcessRole>,
}

/// Internal roles of the program, started only by the program itself.
#[derive(Clone, Debug, Subcommand)]
pub enum ProcessRole {
    /// Compute the jobs read from standard input
    #[command(hide = true)]
    Slot {
        /// Address space of the slot process \[MiB\]; 0 for no limit
        #[arg(long, default_value_t = 0)]
        memory: u64,
    },
    /// Start a program of this machine's list within its limits
    #[command(hide = true)]
    Start(Start),
}
