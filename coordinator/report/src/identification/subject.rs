//! What the report of an identification is about.
use crate::data::Origin;
use discrepancy::identify::Identified;
use protocol::case::{Case, Unknown};

/// A finished identification with everything that its report names.
#[derive(Clone, Debug)]
pub struct Subject<'a> {
    /// The case.
    pub case: &'a Case,
    /// The answer.
    pub identified: &'a Identified,
    /// How it was made.
    pub origin: Origin,
    /// Remarks about case and records.
    pub notes: &'a [String],
    /// Wall time of all sessions (s).
    pub wall_s: f64,
}

impl<'a> Subject<'a> {
    /// An unknown of the case by its name.
    pub(super) fn unknown(&self, name: &str) -> Option<&'a Unknown> {
        self.case
            .unknowns
            .iter()
            .find(|unknown| unknown.name == name)
    }
}
