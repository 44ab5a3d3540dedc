//! Registry of the kinds of model with specific report content: one line each.
use crate::{
    chart::ChartAxis, command_files::ExternalModelReport, drawing::ModelReport,
    general::GenericReport, pumping_unit::PumpingUnitReport,
};
use protocol::{
    case::{Abscissa, Case},
    external,
    pumping_unit::Machine,
};

const ALL: &[(&str, &dyn ModelReport)] = &[
    (Machine::KIND, &PumpingUnitReport),
    (external::KIND, &ExternalModelReport),
];

/// Returns the report content of a case's kind of model; the general content if the kind has none.
pub fn of(case: &Case) -> &'static dyn ModelReport {
    let name = case::kind::family(&case.model.kind);
    let mut all = ALL.iter();
    all.find(|(kind, _)| *kind == name)
        .map_or(&GenericReport, |(_, drawing)| *drawing)
}

/// Returns the scripts of all kinds of model.
pub(super) fn scripts() -> impl Iterator<Item = &'static str> {
    ALL.iter().map(|(_, drawing)| drawing.script())
}

/// Returns the horizontal axis of figures over an abscissa of a case.
pub(super) fn axis(case: &Case, abscissa: &Abscissa) -> ChartAxis {
    ChartAxis::of(abscissa, of(case).zero())
}
