//! Input data of the report of an orthogonal-array test.
use crate::data::Origin;
use protocol::case::Case;
use study::orthogonal::Tested;

/// Orthogonal-array test with all data that its report refers to.
pub struct Subject<'a> {
    /// Case that was searched.
    pub case: &'a Case,
    /// Result of the test.
    pub tested: &'a Tested,
    /// Provenance of the test (run, program, digest).
    pub origin: Origin,
}
