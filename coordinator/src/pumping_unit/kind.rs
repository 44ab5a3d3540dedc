//! Implementation of the model kind "pumping unit" for the coordinator, whose other parts know no particular
//! machine.
use super::{
    digest::simulation_digest,
    output::{
        curves::{CurvesOutput, derivative, predicted},
        score,
    },
};
use crate::kind::Kind;
use discrepancy::identify::Band;
use protocol::{
    case::{Case, Channel},
    job::{ChannelScore, Curves, Per},
    pumping_unit::{Machine, Simulation},
    wire::WireError,
};
use serde_json::{Map, Value};

/// Model kind of pumping units with two horse heads (front and back of the walking beam).
pub(crate) struct PumpingUnits;

impl Kind for PumpingUnits {
    fn name(&self) -> &'static str {
        Machine::KIND
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

    fn scored(&self, channel: &Channel, score: &ChannelScore) -> (String, Map<String, Value>) {
        score::scored(channel, score)
    }
}
