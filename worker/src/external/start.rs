//! Last step before an external program: this process sets its limits and then executes the program in its
//! place.
//!
//! Limits and the parent-death signal must be set between fork and exec. Without unsafe code this requires a
//! process of its own: `horsehead-worker start`.
use clap::Args;
use rustix::process::{
    Resource, Rlimit, Signal, getrlimit, set_parent_process_death_signal, setrlimit,
};
use std::{ffi::OsString, io, os::unix::process::CommandExt, process::Command};

/// Program to execute in place of this process, and its resource limits.
#[derive(Clone, Debug, Args)]
pub struct Start {
    /// Address space of the program \[MiB\]; 0 for no limit
    #[arg(long, default_value_t = 0)]
    pub memory: u64,
    /// Longest file that the program may write \[MiB\]; 0 for no limit
    #[arg(long, default_value_t = 0)]
    pub file: u64,
    /// The program and its arguments
    #[arg(last = true, required = true)]
    pub command: Vec<OsString>,
}

/// Replaces this process by the program (exec).
///
/// # Errors
/// If a limit cannot be set or the program cannot be started.
pub fn start(start: &Start) -> io::Result<()> {
    set_parent_process_death_signal(Some(Signal::KILL))?;
    limit(Resource::As, start.memory)?;
    limit(Resource::Fsize, start.file)?;
    let none = Rlimit {
        current: Some(0),
        maximum: Some(0),
    };
    setrlimit(Resource::Core, none)?;
    let Some((program, arguments)) = start.command.split_first() else {
        return Err(io::Error::other("no program to start was given"));
    };
    Err(Command::new(program).args(arguments).exec())
}

/// Sets the soft and hard limit of a resource (MiB; 0 for none), at most to the present hard limit.
fn limit(resource: Resource, mib: u64) -> io::Result<()> {
    let most = getrlimit(resource).maximum;
    let wanted = mib.saturating_mul(1 << 20);
    let limit = if mib == 0 {
        most
    } else {
        Some(most.map_or(wanted, |most| most.min(wanted)))
    };
    let both = Rlimit {
        current: limit,
        maximum: limit,
    };
    Ok(setrlimit(resource, both)?)
}
