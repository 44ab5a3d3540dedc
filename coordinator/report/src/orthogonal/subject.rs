//! What a report of a test is about.
use crate::data::Origin;
use protocol::case::Case;
use study::orthogonal::Tested;

/// What a report of a test is about.
pub struct Subject<'a> {
    /// The case that was searched.
    pub case: &'a Case,
    /// The test.
    pub tested: &'a Tested,
    /// How it was made.
    pub origin: Origin,
}
