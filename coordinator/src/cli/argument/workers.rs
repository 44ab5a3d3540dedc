//! Worker arguments: worker processes on this machine, and workers of other machines that connect over the
//! network.
use super::{
    listening::ListenChoice,
    nodes::{HostsChoice, LaunchChoice},
};
use clap::{
    Args,
    builder::{RangedU64ValueParser, TypedValueParser},
};
use dispatch::runtime::PAUSE_LIMIT;
use run::session::{RunOptions, launch::RemoteWorkers};
use std::time::Duration;
use support::Problem;

/// Arguments that select the workers of a run.
#[derive(Clone, Debug, Args)]
pub(crate) struct WorkersChoice {
    /// Worker processes to start on this machine; 0 for none [default: one per core].
    #[arg(long, value_name = "N", env = "HORSEHEAD_WORKERS", value_parser = worker_count())]
    workers: Option<usize>,
    /// How long the run waits where its disk is full, or while all that is left are jobs whose workers were lost,
    /// before it ends with what it has, in minutes [default: 10].
    #[arg(long, value_name = "MINUTES", env = "HORSEHEAD_PAUSE_LIMIT", value_parser = clap::value_parser!(u32).range(0..=100_000))]
    pause_limit: Option<u32>,
    /// Show the run in a browser while it goes on: the address of its page is printed; as --dashboard=PORT at a
    /// port of your choice, or the next free one.
    #[arg(
        long,
        value_name = "PORT",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "7450",
        env = "HORSEHEAD_DASHBOARD"
    )]
    dashboard: Option<u16>,
    // the last, because its heading stays in force
    #[command(flatten)]
    pub(crate) remote: RemoteChoice,
}

/// Arguments that let workers of other machines take part, and that launch such workers for the time of a run.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Workers on other machines")]
pub(crate) struct RemoteChoice {
    #[command(flatten)]
    listen: ListenChoice,
    #[command(flatten)]
    hosts: HostsChoice,
    /// Name or address under which the ssh hosts reach this machine [default: the one from which the first of
    /// them says that we come].
    #[arg(long, value_name = "ADDRESS", env = "HORSEHEAD_ADVERTISE")]
    advertise: Option<String>,
    #[command(flatten)]
    launch: LaunchChoice,
}

impl WorkersChoice {
    /// Returns the number of worker processes to start on this machine, by default one per core.
    pub(crate) fn local(&self) -> usize {
        self.workers.unwrap_or_else(cores)
    }

    /// Returns the options of a session with these workers.
    ///
    /// # Errors
    /// As [`RemoteChoice::workers`].
    pub(crate) fn session(&self) -> Result<RunOptions, Problem> {
        let minutes = |minutes: u32| Duration::from_secs(60 * u64::from(minutes));
        Ok(RunOptions {
            local_workers: self.local(),
            pause_limit: self.pause_limit.map_or(PAUSE_LIMIT, minutes),
            dashboard: self.dashboard,
            remote: self.remote.workers()?,
        })
    }
}

impl RemoteChoice {
    /// Returns whether the arguments let workers on other machines take part.
    pub(crate) const fn has_others(&self) -> bool {
        self.listen.is_open() || !self.hosts.is_empty()
    }

    /// Returns the workers of other machines that the arguments name.
    ///
    /// # Errors
    /// If the file of hosts, or that of shell lines, cannot be read.
    pub(crate) fn workers(&self) -> Result<RemoteWorkers, Problem> {
        let hosts = self.hosts.read()?;
        Ok(RemoteWorkers {
            access: self.listen.access(),
            advertise: self.advertise.clone(),
            slots: self.launch.slots,
            programs: self.launch.worker_program.clone(),
            // who launches nothing needs no file of shell lines
            prologue: if hosts.is_empty() {
                String::new()
            } else {
                self.launch.prologue()?
            },
            hosts,
        })
    }
}

/// Returns the parser for the number of local worker processes, 0 to 1024; more would only compete for the
/// cores.
pub(crate) fn worker_count() -> impl TypedValueParser<Value = usize> {
    RangedU64ValueParser::<usize>::new().range(0..=1024)
}

pub(crate) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
