//! What a report of a test is about.
use crate::report::data::Origin;
use protocol::case::Case;
use study::orthogonal::Tested;

/// What a report of a test is about.
pub(crate) struct Subject<'a> {
    /// The case that was searched.
    pub(crate) case: &'a Case,
    /// The test.
    pub(crate) tested: &'a Tested,
    /// How it was made.
    pub(crate) origin: Origin,
}
