//! Ranges of job numbers: a job keeps its number in the journal, so that a resumed run finds its result.
//!
//! A search numbers its individuals from 0 in the order of its proposals; a diagnosis and an identification
//! number their experiments from [`EXPERIMENTS`] in the order of request. Jobs in any order have numbers from the hash of
//! their content, of [`CONTENT_BITS`] bits. What a run requests beside them lies above.
use protocol::id::JobId;

/// Number of the job that asks a worker for its effects.
pub const LIBRARY: u64 = 0;
/// Number of the first experiment of a diagnosis or an identification.
pub const EXPERIMENTS: u64 = LIBRARY + 1;
/// Number of the first comparison job of a calibration, which scores or simulates a selected individual; above the
/// number of any individual of a search.
pub const COMPARISONS: u64 = 1 << 40;
/// Number of bits of a hash that form a job number; every table format represents integers of this size exactly.
pub const CONTENT_BITS: u32 = 48;
/// Number of the first job that measures the cost of derivatives in a scaling measurement, above those by content.
pub const DERIVATIVE_COSTS: u64 = 1 << CONTENT_BITS;
/// Number of bits of a job number within one search of a scaling measurement; the bits above number the searches from 1.
pub const SEARCH_BITS: u32 = 50;
/// Number of the first experiment of the identifiability estimate after a calibration, above its comparisons.
pub const IDENTIFIABILITY: u64 = 1 << 50;
/// Bit that the numbers of parts of divided jobs and of jobs computed ahead have, and submitted jobs have not. Such
/// jobs are not in the journal, and a later process may not request them again.
pub const PARTS: u64 = 1 << 63;

/// Returns whether a number is that of a part of a divided job, or of a job computed ahead.
pub const fn is_part(JobId(number): JobId) -> bool {
    number & PARTS != 0
}
