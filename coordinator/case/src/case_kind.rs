//! What a kind of model may add to how its cases are read.
use crate::{
    error::CaseError,
    general,
    loaded::Loaded,
    source::Source,
    summary::{self, Summary},
};
use discrepancy::thresholds::Thresholds;
use protocol::{case::Case, job::Numerics, wire::WireError};

/// A kind of model as its cases are read.
pub trait CaseKind: Sync {
    /// As cases name it.
    fn name(&self) -> &'static str;

    /// Reads a case.
    ///
    /// # Errors
    /// What is wrong; see [`CaseError`].
    fn read(&self, source: &Source<'_>) -> Result<Loaded, CaseError> {
        general::read(source)
    }

    /// Reads a case and says what is in it.
    ///
    /// # Errors
    /// As [`Self::read`].
    fn check(&self, source: &Source<'_>) -> Result<Summary, CaseError> {
        let loaded = self.read(source)?;
        Ok(Summary::new(
            &loaded,
            self.unknowns(),
            summary::text(&loaded),
        ))
    }

    /// Which field of a case is missing where a condition has no record, and what to do.
    fn missing_record(&self, condition: usize, name: &str) -> (String, String) {
        (
            format!("conditions[{condition}]"),
            format!("state `record` for a [[channels]] table of condition `{name}`"),
        )
    }

    /// Key of the unknowns in objects.
    fn unknowns(&self) -> &'static str {
        "unknowns"
    }

    /// Values of the unknowns in a form that other programs for this kind of model read: name and text of a file.
    fn gene_file(&self, _: &Case, _genes: &[f64]) -> Option<(&'static str, String)> {
        None
    }

    /// Whether a simulation starts a program of which nothing is known here, not even how long it runs.
    fn is_program(&self) -> bool {
        false
    }

    /// Why workers of this machine cannot take part in a run on a case as things are, and what to do about it.
    fn unready(&self, _: &Case) -> Option<(String, String)> {
        None
    }

    /// How a diagnosis has its experiments computed, and how more finely, for the numerical check: the
    /// finest, then what it is made of, one thing at a time. Nothing where nothing can be finer.
    ///
    /// # Errors
    /// If the case says nothing of this kind.
    fn numerics(&self, _: &Case, _: &Thresholds) -> Result<(Numerics, Vec<Numerics>), WireError> {
        Ok((Numerics::OF_THE_CASE, Vec::new()))
    }
}

/// A kind of which no more is known.
pub(crate) struct AnyKind;

impl CaseKind for AnyKind {
    fn name(&self) -> &'static str {
        ""
    }
}
