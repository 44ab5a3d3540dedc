//! Parts of the JSON output that depend on the kind of model.
mod digest;
mod model_output;
mod pumping_unit;

use case::kind::{CommandModel, KnownKind, OtherModel, PumpingUnitModel};
pub(crate) use model_output::ModelOutput;
use protocol::case::Case;
#[cfg(test)]
pub(crate) use pumping_unit::simulation_digest;

impl ModelOutput for CommandModel {}

/// Returns the output of a case's kind of model.
pub(crate) fn of(case: &Case) -> &'static dyn ModelOutput {
    match KnownKind::of(case) {
        KnownKind::PumpingUnit => &PumpingUnitModel,
        KnownKind::Command => &CommandModel,
        KnownKind::Other => &OtherModel,
    }
}
