//! List of the model kinds that have their own JSON output, one line each; every other kind uses the general
//! output.
mod known;

use known::AnyKind;
pub(crate) use known::Kind;

use crate::pumping_unit::kind::PumpingUnits;
use protocol::case::Case;

const ALL: &[&dyn Kind] = &[&PumpingUnits];

/// Returns the output formats of the model kind with the given name; the default formats for an unlisted
/// name.
pub(crate) fn named(name: &str) -> &'static dyn Kind {
    let name = case::kind::family(name);
    let mut all = ALL.iter().copied();
    all.find(|kind| kind.name() == name).unwrap_or(&AnyKind)
}

/// Returns the output formats of a case's model kind.
pub(crate) fn of(case: &Case) -> &'static dyn Kind {
    named(&case.model.kind)
}
