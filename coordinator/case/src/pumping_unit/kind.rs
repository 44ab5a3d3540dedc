//! Kind of model for pumping units.
use super::{figures, numerics::numerics, read};
use crate::{
    case_kind::ModelKind, error::CaseError, loaded::Loaded, source::RecordFolder,
    summary::CaseSummary,
};
use protocol::{
    case::{Case, Unknown},
    job::Numerics,
    pumping_unit::{Coefficient, Machine},
    wire::WireError,
};

/// Pumping unit with double horse heads.
#[derive(Clone, Copy, Debug)]
pub struct PumpingUnitModel;

impl ModelKind for PumpingUnitModel {
    fn read(&self, source: &RecordFolder<'_>) -> Result<Loaded, CaseError> {
        read::read(source).map(|resolved| resolved.loaded)
    }

    fn check(&self, source: &RecordFolder<'_>) -> Result<CaseSummary, CaseError> {
        figures::summary(source)
    }

    fn missing_record(&self, condition: usize, name: &str) -> (String, String) {
        let remedy = format!(
            "add record_file = \"measured/test_{name}.csv.gz\" to the condition (time_s, crank_deg, \
             stress_1_mpa .. stress_4_mpa; its data sheet is test_{name}.toml beside it)"
        );
        (format!("conditions[{condition}].record_file"), remedy)
    }

    fn finer_settings(&self, case: &Case, refinement: f64) -> Result<Vec<String>, WireError> {
        super::numerics::finer_settings(case, refinement)
    }

    fn diagnosis_numerics(
        &self,
        case: &Case,
        step: f64,
        refinement: f64,
    ) -> Result<(Numerics, Vec<Numerics>), WireError> {
        numerics(case, step, refinement)
    }

    fn abscissa_origin(&self) -> &'static str {
        " from bottom dead centre"
    }

    fn group(&self, unknown: &Unknown) -> &'static str {
        match Coefficient::named(&unknown.name) {
            Some(Coefficient::Kc | Coefficient::Cc) => "Contact",
            Some(_) => "Rope joints",
            None => "Unknowns",
        }
    }

    fn frequency_hz(&self, case: &Case, condition: usize) -> Option<f64> {
        let machine = Machine::of(case).ok()?;
        Some(machine.conditions.get(condition)?.speed_rpm / 60.0)
    }

    fn unknowns_key(&self) -> &'static str {
        "genes"
    }
}
