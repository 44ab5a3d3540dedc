//! The pumping unit as the coordinator's general parts ask for it.
use super::{
    case,
    digest::simulation_digest,
    numerics::numerics,
    output::{
        curves::{CurvesOutput, derivative, predicted},
        score,
    },
    report::Dhh,
};
use crate::{
    case::{CaseError, Loaded, Summary, source::Source},
    kind::Kind,
    report::Drawing,
};
use discrepancy::{identify::Band, thresholds::Thresholds};
use protocol::{
    case::{Case, Channel},
    job::{ChannelScore, Curves, Numerics, Per},
    pumping_unit::{Machine, Simulation},
    wire::WireError,
};
use serde_json::{Map, Value};

/// Pumping units with double horse heads.
pub(crate) struct PumpingUnits;

impl Kind for PumpingUnits {
    fn name(&self) -> &'static str {
        Machine::KIND
    }

    fn read(&self, source: &Source<'_>) -> Result<Loaded, CaseError> {
        case::read(source).map(|resolved| resolved.loaded)
    }

    fn check(&self, source: &Source<'_>) -> Result<Summary, CaseError> {
        case::summary(source)
    }

    fn missing_record(&self, condition: usize, name: &str) -> (String, String) {
        let remedy = format!(
            "add record_file = \"measured/test_{name}.csv.gz\" to the condition (time_s, crank_deg, \
             stress_1_mpa .. stress_4_mpa; its data sheet is test_{name}.toml beside it)"
        );
        (format!("conditions[{condition}].record_file"), remedy)
    }

    fn numerics(
        &self,
        case: &Case,
        thresholds: &Thresholds,
    ) -> Result<(Numerics, Vec<Numerics>), WireError> {
        numerics(case, thresholds)
    }

    fn drawing(&self) -> &'static dyn Drawing {
        &Dhh
    }

    fn digest(&self, drawn: &Curves) -> Result<String, WireError> {
        Simulation::of(drawn).map(|simulation| simulation_digest(&simulation))
    }

    fn drawn(&self, _: &Case, _: usize, drawn: &Curves) -> Result<Map<String, Value>, WireError> {
        let simulation = Simulation::of(drawn)?;
        let value = serde_json::to_value(CurvesOutput::from(&simulation));
        match value {
            Ok(Value::Object(map)) => Ok(map),
            Ok(_) | Err(_) => Ok(Map::new()),
        }
    }

    fn derivative(
        &self,
        case: &Case,
        condition: usize,
        per: &Per,
        curves: &[Vec<f32>],
    ) -> Map<String, Value> {
        derivative(case, condition, per, curves)
    }

    fn predicted(&self, case: &Case, band: &Band) -> Map<String, Value> {
        predicted(case, band)
    }

    fn unknowns(&self) -> &'static str {
        "genes"
    }

    fn scored(&self, channel: &Channel, score: &ChannelScore) -> (String, Map<String, Value>) {
        score::scored(channel, score)
    }
}
