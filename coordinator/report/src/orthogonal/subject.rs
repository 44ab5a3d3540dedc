//! Input data of the report of an orthogonal-array test.
use crate::data::Origin;
use protocol::case::Case;
use study::orthogonal::TestResult;

/// Orthogonal-array test with all data that its report refers to.
pub struct SweepInput<'a> {
    /// Case on which the search settings were tested.
    pub case: &'a Case,
    /// Result of the orthogonal-array test.
    pub tested: &'a TestResult,
    /// Provenance of the test (run, program, digest).
    pub origin: Origin,
}
