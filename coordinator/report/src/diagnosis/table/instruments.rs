//! Tables of the instrument errors (nuisance parameters) and of the effects that the record cannot show.
use crate::diagnosis::subject::DiagnosisInput;
use crate::document::{Row, Table};
use crate::number::{percent, quantity};
use discrepancy::diagnose::NuisanceEstimate;

/// Builds the table of the estimated instrument errors, with their intervals and tolerances.
pub(in crate::diagnosis) fn instruments(subject: &DiagnosisInput<'_>) -> Option<Table> {
    let nuisances = &subject.diagnosis().nuisances;
    let row = |own: &NuisanceEstimate| {
        let of = |x: f64| quantity(x, &own.unit);
        let [low, high] = own.interval.map(of);
        let tolerance = of(own.tolerance);
        Row::new(
            format!("{}, {}", own.id, own.parameter.replace('_', " ")),
            [
                of(own.value),
                format!("{low} to {high}"),
                if own.assumed {
                    format!("{tolerance}, assumed")
                } else {
                    tolerance
                },
                if own.within { "within" } else { "beyond" }.to_owned(),
            ],
        )
    };
    Table::new(
        "Instruments and what else is never exact",
        ["", "off by", "95 % interval", "good to", "within 3 standard deviations"],
        nuisances.iter().map(row).collect(),
    )
    .with_notes([
        "Each is a parameter of every fit, with its tolerance (one standard deviation, from the data \
         sheet) as prior. An error within three standard deviations is no finding.",
    ])
    .non_empty()
}

/// Builds the table of effects whose signature the unknowns absorb, with the measurement that would reveal
/// each.
pub(in crate::diagnosis) fn absorbed(subject: &DiagnosisInput<'_>) -> Option<Table> {
    let absorbed = subject.diagnosis().absorbed.iter();
    let rows = absorbed.map(|own| {
        Row::new(
            own.id.as_str(),
            [percent(own.share), own.measurement.clone()],
        )
    });
    Table::new(
        "Effects that this record cannot show, since recalibration absorbs them",
        ["", "taken up", "what would show it"],
        rows.collect(),
    )
    .non_empty()
}
