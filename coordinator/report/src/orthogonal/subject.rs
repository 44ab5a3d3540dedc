//! Input data of the report of an orthogonal-array test.
use crate::data::Origin;
use protocol::case::Case;
use study::orthogonal::TestResult;

/// Orthogonal-array test with all data that its report refers to.
pub struct SweepInput<'a> {
    /// Case that was searched.
    pub case: &'a Case,
    /// Result of the test.
    pub tested: &'a TestResult,
    /// Provenance of the test (run, program, digest).
    pub origin: Origin,
}
