//! The kinds of models of which the coordinator knows more than their cases say: one line each. Every
//! other kind is read, computed, shown and written down by the general form alone.
mod known;

use known::AnyKind;
pub(crate) use known::Kind;

use crate::pumping_unit::kind::PumpingUnits;
use protocol::case::Case;

const ALL: &[&dyn Kind] = &[&PumpingUnits];

/// The kind of a name.
pub(crate) fn named(name: &str) -> &'static dyn Kind {
    let name = case::kind::family(name);
    let mut all = ALL.iter().copied();
    all.find(|kind| kind.name() == name).unwrap_or(&AnyKind)
}

/// The kind that a case is of.
pub(crate) fn of(case: &Case) -> &'static dyn Kind {
    named(&case.model.kind)
}
