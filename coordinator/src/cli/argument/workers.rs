//! Worker arguments: worker processes on this machine, and workers of other machines that connect over the
//! network.
use super::{
    listening::RemoteAccess,
    nodes::{HostsChoice, LaunchChoice},
};
use clap::{
    Args,
    builder::{RangedU64ValueParser, TypedValueParser},
};
use dispatch::runtime::PAUSE_LIMIT;
use std::time::Duration;

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
    pub(crate) dashboard: Option<u16>,
    // the last, because its heading stays in force
    #[command(flatten)]
    pub(crate) remote: RemoteChoice,
}

/// Arguments that let workers of other machines take part, and that launch such workers for the time of a run.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Workers on other machines")]
pub(crate) struct RemoteChoice {
    #[command(flatten)]
    pub(crate) door: RemoteAccess,
    #[command(flatten)]
    pub(crate) hosts: HostsChoice,
    /// Name or address under which the ssh hosts reach this machine [default: the one from which the first of
    /// them says that we come].
    #[arg(long, value_name = "ADDRESS", env = "HORSEHEAD_ADVERTISE")]
    pub(crate) advertise: Option<String>,
    #[command(flatten)]
    pub(crate) launch: LaunchChoice,
}

impl WorkersChoice {
    /// Returns the number of worker processes to start on this machine, by default one per core.
    pub(crate) fn local(&self) -> usize {
        self.workers.unwrap_or_else(cores)
    }

    /// Returns how long the run waits for room on its disk, or for new workers, before it ends.
    pub(crate) fn pause_limit(&self) -> Duration {
        let minutes = |minutes: u32| Duration::from_secs(60 * u64::from(minutes));
        self.pause_limit.map_or(PAUSE_LIMIT, minutes)
    }
}

impl RemoteChoice {
    /// Returns whether the arguments let workers on other machines take part.
    pub(crate) const fn has_others(&self) -> bool {
        self.door.listen.is_some() || !self.hosts.is_empty()
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
