//! JSON output of pumping units.
mod curves;
mod digest;
mod score;

use super::model_output::ModelOutput;
use case::kind::PumpingUnitModel;
use curves::{CurvesOutput, derivative, predicted};
pub(crate) use digest::simulation_digest;
use discrepancy::identify::Band;
use protocol::{
    case::{Case, Channel},
    job::{ChannelScore, Curves, Per},
    pumping_unit::Simulation,
    wire::WireError,
};
use serde_json::{Map, Value};

impl ModelOutput for PumpingUnitModel {
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

    fn scored(&self, channel: &Channel, score: &ChannelScore) -> (String, Map<String, Value>) {
        score::scored(channel, score)
    }
}
