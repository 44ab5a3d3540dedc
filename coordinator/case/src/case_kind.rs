//! Interface through which a kind of model customises how its cases are read.
use crate::{
    error::CaseError,
    general,
    loaded::Loaded,
    source::Source,
    summary::{self, Summary},
};
use discrepancy::thresholds::Thresholds;
use protocol::{case::Case, job::Numerics, wire::WireError};

/// Kind of model, as seen by the code that reads cases; every method but `name` has a default for a generic
/// model.
pub trait CaseKind: Sync {
    /// Returns the name of the kind, as `[model] kind` of a case file states it.
    fn name(&self) -> &'static str;

    /// Reads a case.
    ///
    /// # Errors
    /// Returns a [`CaseError`] that names the file or field at fault.
    fn read(&self, source: &Source<'_>) -> Result<Loaded, CaseError> {
        general::read(source)
    }

    /// Reads a case and summarises its contents.
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

    /// Returns the path of the case field that is missing where a condition has no measured record, and the
    /// remedy.
    fn missing_record(&self, condition: usize, name: &str) -> (String, String) {
        (
            format!("conditions[{condition}]"),
            format!("state `record` for a [[channels]] table of condition `{name}`"),
        )
    }

    /// Returns the key under which the names of the unknowns stand in JSON output.
    fn unknowns(&self) -> &'static str {
        "unknowns"
    }

    /// Returns the name and text of a file with the values of the unknowns in a format that other programs
    /// for this kind of model read, if the kind has one.
    fn gene_file(&self, _: &Case, _genes: &[f64]) -> Option<(&'static str, String)> {
        None
    }

    /// Returns whether a simulation starts an external program, whose internals and run time are unknown to
    /// the coordinator.
    fn is_program(&self) -> bool {
        false
    }

    /// Returns why workers on this machine cannot currently take part in a run on a case, and the remedy;
    /// `None` if they can.
    fn unready(&self, _: &Case) -> Option<(String, String)> {
        None
    }

    /// Returns the numerical settings for the experiments of a diagnosis, and the finer settings for its
    /// numerical check: first the finest, then each of its refinements alone. The list is empty where nothing
    /// can be refined.
    ///
    /// # Errors
    /// Returns an error if the case has no settings of this kind.
    fn numerics(&self, _: &Case, _: &Thresholds) -> Result<(Numerics, Vec<Numerics>), WireError> {
        Ok((Numerics::OF_THE_CASE, Vec::new()))
    }
}

/// Generic kind of model without any customisation.
pub(crate) struct AnyKind;

impl CaseKind for AnyKind {
    fn name(&self) -> &'static str {
        ""
    }
}
