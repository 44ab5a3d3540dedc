//! Names of the kinds of jobs: what workers announce, what jobs and answers say they are, what tables
//! show. Nothing here knows what a job does.

/// Simulate and compare with the records.
pub const SCORE: &str = "score";
/// Simulate and return the curves.
pub const SIMULATE: &str = "simulate";
/// Simulate and return the measured channels alone.
pub const OBSERVE: &str = "observe";
/// Say which effects there are.
pub const DESCRIBE: &str = "describe";
/// Reduce the flexible back head: it takes minutes where others take seconds.
pub const REDUCE_HEAD: &str = "reduce_head";
/// Do nothing.
pub const NOTHING: &str = "nothing";

/// All that a worker of this build does, in the order in which it says so.
pub const ALL: [&str; 6] = [SCORE, SIMULATE, OBSERVE, DESCRIBE, REDUCE_HEAD, NOTHING];
