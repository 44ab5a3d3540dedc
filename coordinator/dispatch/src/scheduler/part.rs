//! Ids of the parts of divided jobs and of jobs computed ahead: they are not in the journal, and a later
//! coordinator process may not submit them again.
use protocol::id::JobId;

/// Bit that the ids of parts have and ids of submitted jobs do not.
pub(crate) const PART: u64 = 1 << 63;

/// Returns whether an id is that of a part.
pub(crate) const fn is_part(id: JobId) -> bool {
    id.0 & PART != 0
}
