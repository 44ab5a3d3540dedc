//! Registry of the kinds of models with output formats of their own, one line each. Every other kind is read,
//! computed, displayed and written in the general form.
mod known;

use known::AnyKind;
pub(crate) use known::Kind;

use crate::pumping_unit::kind::PumpingUnits;
use protocol::case::Case;

const ALL: &[&dyn Kind] = &[&PumpingUnits];

/// Returns the kind of model with the given name, or the default kind.
pub(crate) fn named(name: &str) -> &'static dyn Kind {
    let name = case::kind::family(name);
    let mut all = ALL.iter().copied();
    all.find(|kind| kind.name() == name).unwrap_or(&AnyKind)
}

/// Returns the kind of model of a case.
pub(crate) fn of(case: &Case) -> &'static dyn Kind {
    named(&case.model.kind)
}
