//! How many worker processes a command starts on this machine.
use clap::builder::{RangedU64ValueParser, TypedValueParser};

/// Numbers of local worker processes: more would only get in each other's way.
pub(crate) fn worker_count() -> impl TypedValueParser<Value = usize> {
    RangedU64ValueParser::<usize>::new().range(0..=1024)
}

/// How many local worker processes to start by default: one per core.
pub(crate) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
