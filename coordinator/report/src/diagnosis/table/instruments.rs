//! What is never exact about the record, and what the record cannot show.
use crate::diagnosis::subject::Subject;
use crate::document::{Row, Table};
use crate::number::{percent, quantity};
use discrepancy::diagnose::NeverExact;

/// What the instruments are off by, beside the answer.
pub(in crate::diagnosis) fn instruments(subject: &Subject<'_>) -> Option<Table> {
    let nuisances = &subject.diagnosis().nuisances;
    let row = |own: &NeverExact| {
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
        ["", "off by", "95 % interval", "good to", "three of that"],
        nuisances.iter().map(row).collect(),
    )
    .noted([
        "Each is a parameter of every fit, with what it is good to (one standard deviation, from the data \
         sheet) known beforehand. Within three of that it is no discovery.",
    ])
    .unless_empty()
}

/// Effects that the unknowns take up, and what would show them.
pub(in crate::diagnosis) fn absorbed(subject: &Subject<'_>) -> Option<Table> {
    let absorbed = subject.diagnosis().absorbed.iter();
    let rows = absorbed.map(|own| {
        Row::new(
            own.id.as_str(),
            [percent(own.share), own.measurement.clone()],
        )
    });
    Table::new(
        "What this record cannot show, since recalibration takes it up",
        ["", "taken up", "what would show it"],
        rows.collect(),
    )
    .unless_empty()
}
