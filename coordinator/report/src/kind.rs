//! The kinds of models that show more in reports than all of them do: one line each.
use crate::{
    chart::Axis, command_files::Files, drawing::Drawing, general::General, pumping_unit::Dhh,
};
use protocol::{
    case::{Abscissa, Case},
    external,
    pumping_unit::Machine,
};

const ALL: &[(&str, &dyn Drawing)] = &[(Machine::KIND, &Dhh), (external::KIND, &Files)];

/// How results of a case are shown.
pub fn of(case: &Case) -> &'static dyn Drawing {
    let name = case::kind::family(&case.model.kind);
    let mut all = ALL.iter();
    all.find(|(kind, _)| *kind == name)
        .map_or(&General, |(_, drawing)| *drawing)
}

/// The axis of a channel of a case.
pub(super) fn axis(case: &Case, abscissa: &Abscissa) -> Axis {
    Axis::of(abscissa, of(case).zero())
}
