//! Who works on a run: worker processes on this machine, and others through the door.
use super::door::Door;
use clap::{
    Args,
    builder::{RangedU64ValueParser, TypedValueParser},
};

/// Who works on a run.
#[derive(Clone, Debug, Args)]
pub(crate) struct WorkersChoice {
    #[command(flatten)]
    pub(crate) door: Door,
    /// Worker processes to start on this machine; 0 for none [default: one per core].
    #[arg(long, value_name = "N", env = "HORSEHEAD_WORKERS", value_parser = worker_count())]
    workers: Option<usize>,
}

impl WorkersChoice {
    /// Worker processes to start on this machine.
    pub(crate) fn local(&self) -> usize {
        self.workers.unwrap_or_else(cores)
    }
}

/// Numbers of local worker processes: more would only get in each other's way.
pub(crate) fn worker_count() -> impl TypedValueParser<Value = usize> {
    RangedU64ValueParser::<usize>::new().range(0..=1024)
}

/// How many local worker processes to start by default: one per core.
pub(crate) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
