//! Input data of an identification report.
use crate::data::Origin;
use discrepancy::identify::IdentificationResult;
use protocol::case::{Case, Unknown};

/// Finished identification with all data that its report refers to.
#[derive(Clone, Debug)]
pub struct IdentificationInput<'a> {
    /// Case whose unknowns were identified.
    pub case: &'a Case,
    /// Result of the identification.
    pub identified: &'a IdentificationResult,
    /// Provenance of the identification (run, program, digest).
    pub origin: Origin,
    /// Remarks about the case and its records.
    pub notes: &'a [String],
    /// Wall time of the identification, over all sessions (s).
    pub wall_s: f64,
}

impl<'a> IdentificationInput<'a> {
    /// Returns an unknown of the case by its name.
    pub(super) fn unknown(&self, name: &str) -> Option<&'a Unknown> {
        self.case
            .unknowns
            .iter()
            .find(|unknown| unknown.name == name)
    }
}
