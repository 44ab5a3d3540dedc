//! Report content of each kind of model.
use crate::model_report::ModelReport;
use case::kind::{CommandModel, KnownKind, OtherModel, PumpingUnitModel};
use protocol::case::Case;

/// Returns the report content of a case's kind of model.
pub fn of(case: &Case) -> &'static dyn ModelReport {
    content(KnownKind::of(case))
}

const fn content(kind: KnownKind) -> &'static dyn ModelReport {
    match kind {
        KnownKind::PumpingUnit => &PumpingUnitModel,
        KnownKind::Command => &CommandModel,
        KnownKind::Other => &OtherModel,
    }
}

/// Returns the scripts of all kinds of model.
pub(super) fn scripts() -> impl Iterator<Item = &'static str> {
    KnownKind::ALL
        .into_iter()
        .map(|kind| content(kind).script())
}
