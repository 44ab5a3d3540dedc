//! What the parts of the program ask of a kind of model: how its cases are read, and how its quantities are called.
use crate::{
    error::CaseError,
    general,
    loaded::Loaded,
    source::RecordFolder,
    summary::{self, CaseSummary},
};
use protocol::{
    case::{Case, Unknown},
    job::Numerics,
    wire::WireError,
};
use record::Curves;

/// Kind of model; every method has a default for any model.
pub trait ModelKind: Sync {
    /// Reads a case.
    ///
    /// # Errors
    /// Returns a [`CaseError`] that names the file or field at fault.
    fn read(&self, source: &RecordFolder<'_>) -> Result<Loaded, CaseError> {
        general::read(source)
    }

    /// Reads a case and summarises its contents.
    ///
    /// # Errors
    /// As [`Self::read`].
    fn check(&self, source: &RecordFolder<'_>) -> Result<CaseSummary, CaseError> {
        let loaded = self.read(source)?;
        Ok(CaseSummary::new(
            &loaded,
            self.unknowns_key(),
            summary::text(&loaded),
        ))
    }

    /// Returns the path of the case field that a user must add where a condition has no measured record, and
    /// the instruction to add it.
    fn missing_record(&self, condition: usize, name: &str) -> (String, String) {
        (
            format!("conditions[{condition}]"),
            format!("state `record` for a [[channels]] table of condition `{name}`"),
        )
    }

    /// Returns the description of the abscissas' origin, such as " from bottom dead centre", appended to an
    /// abscissa's name in the titles of axes; empty where none is needed.
    fn abscissa_origin(&self) -> &'static str {
        ""
    }

    /// Returns the title of the group of table rows to which an unknown belongs; parameters of effects have a
    /// group of their own.
    fn group(&self, _: &Unknown) -> &'static str {
        "Unknowns"
    }

    /// Returns the repetition frequency of a periodic process under a condition \[Hz\]; `None` where nothing
    /// is periodic.
    fn frequency_hz(&self, _: &Case, _condition: usize) -> Option<f64> {
        None
    }

    /// Returns the key under which the names of the unknowns stand in JSON output.
    fn unknowns_key(&self) -> &'static str {
        "unknowns"
    }

    /// Returns the name and text of a parameter file with the given values of the unknowns, in the format of
    /// other programs for this kind of model; `None` if the kind has no such format.
    fn gene_file(&self, _: &Case, _genes: &[f64]) -> Option<(&'static str, String)> {
        None
    }

    /// Returns the name and content of a file with the derivatives of channels by `unknowns`, in the format of other
    /// programs for this kind of model; `None` if the kind has no such format. `channels` holds the index of each channel
    /// among those of the calibrated condition, `derivatives` their curves by each unknown: per decade on a logarithmic
    /// scale, else per declared unit.
    fn jacobian_file(
        &self,
        _: &Case,
        _unknowns: &[&str],
        _channels: &[usize],
        _derivatives: &[Curves],
    ) -> Option<(&'static str, Vec<u8>)> {
        None
    }

    /// Returns whether a simulation starts an external program, whose internals and run time are unknown to
    /// the coordinator.
    fn is_program(&self) -> bool {
        false
    }

    /// Returns the reason why workers on this machine cannot currently simulate a case, and the remedy;
    /// `None` if they can.
    fn readiness_problem(&self, _: &Case) -> Option<(String, String)> {
        None
    }

    /// Returns the numerical settings (step sizes, discretisation) for the simulations of a diagnosis, and
    /// finer settings with which its discretisation error is checked: first everything refined, then each
    /// refinement alone. The list of finer settings is empty where nothing can be refined. `step` is the longest
    /// integration step as a share of the case's, `refinement` the size of a finer element as a share of the case's.
    ///
    /// # Errors
    /// Returns an error if the case has no settings of this kind.
    fn diagnosis_numerics(
        &self,
        _: &Case,
        _step: f64,
        _refinement: f64,
    ) -> Result<(Numerics, Vec<Numerics>), WireError> {
        Ok((Numerics::FROM_CASE, Vec::new()))
    }

    /// Returns the lines of the case file, as `key = value` with dotted keys, that make the case as fine as the
    /// finest settings of [`Self::diagnosis_numerics`]; empty where a case file cannot state them.
    ///
    /// # Errors
    /// As [`Self::diagnosis_numerics`].
    fn finer_settings(&self, _: &Case, _refinement: f64) -> Result<Vec<String>, WireError> {
        Ok(Vec::new())
    }
}

/// Any model without a form of its own, which has all default methods.
#[derive(Clone, Copy, Debug)]
pub struct OtherModel;

impl ModelKind for OtherModel {}
