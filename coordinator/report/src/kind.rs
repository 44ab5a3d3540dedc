//! Registry of the kinds of model with specific report content: one line each.
use crate::{
    chart::Axis, command_files::Files, drawing::Drawing, general::General, pumping_unit::Dhh,
};
use protocol::{
    case::{Abscissa, Case},
    external,
    pumping_unit::Machine,
};

const ALL: &[(&str, &dyn Drawing)] = &[(Machine::KIND, &Dhh), (external::KIND, &Files)];

/// Returns the report content of a case's kind of model; the general content if the kind has none.
pub fn of(case: &Case) -> &'static dyn Drawing {
    let name = case::kind::family(&case.model.kind);
    let mut all = ALL.iter();
    all.find(|(kind, _)| *kind == name)
        .map_or(&General, |(_, drawing)| *drawing)
}

/// Returns the axis for an abscissa of a case.
pub(super) fn axis(case: &Case, abscissa: &Abscissa) -> Axis {
    Axis::of(abscissa, of(case).zero())
}
