//! Channels of simulations as CSV: one row per channel and point.
//!
//! An empty field is a missing value; numbers are written with all their digits.
use super::data::{SimulationView, SingleRun};
use super::number::field;
use super::words::condition_name;
use protocol::job::Derivative;
use std::io::Write;

const COLUMNS: [&str; 10] = [
    "condition",
    "parameters",
    "channel",
    "unit",
    "abscissa",
    "abscissa_unit",
    "at",
    "measured",
    "spread",
    "simulated",
];

/// Writes the channels of named simulations of one case as CSV; a failed simulation has values up to its
/// failure.
///
/// # Errors
/// [`csv::Error`] when the writer fails.
pub(super) fn curves(
    to: impl Write,
    runs: &[(&str, SimulationView<'_>)],
) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_writer(to);
    writer.write_record(COLUMNS)?;
    for (parameters, run) in runs {
        let condition = condition_name(run.case, run.condition);
        for (_, channel) in run.case.channels_of(run.condition) {
            let (record, simulated) = (channel.record.as_ref(), run.channel(channel));
            let abscissa = &channel.abscissa;
            for (index, &at) in abscissa.points.iter().enumerate() {
                let value = |values: Option<&[f64]>| {
                    field(values.and_then(|values| values.get(index).copied()))
                };
                let numbers = [
                    field(Some(at)),
                    value(record.map(|record| record.mean.as_slice())),
                    value(record.map(|record| record.spread.as_slice())),
                    value(Some(simulated)),
                ];
                let names = [
                    condition.as_str(),
                    parameters,
                    &channel.name,
                    &channel.unit,
                    &abscissa.name,
                    &abscissa.unit,
                ];
                writer.write_record(names.into_iter().chain(numbers.iter().map(String::as_str)))?;
            }
        }
    }
    Ok(writer.flush()?)
}

/// Writes the derivatives of one simulation's curves as CSV, one row per unknown, channel and point.
///
/// # Errors
/// [`csv::Error`] when the writer fails.
pub(super) fn derivatives(to: impl Write, run: &SingleRun) -> Result<(), csv::Error> {
    const COLUMNS: [&str; 8] = [
        "condition",
        "by",
        "channel",
        "unit",
        "abscissa",
        "abscissa_unit",
        "at",
        "derivative",
    ];
    let mut writer = csv::Writer::from_writer(to);
    writer.write_record(COLUMNS)?;
    let condition = condition_name(&run.case, run.condition);
    for (name, derivative) in run.derived.iter().zip(&run.curves.columns) {
        let Derivative::Curves { per, curves } = derivative else {
            continue;
        };
        let channels = run.case.channels_of(run.condition);
        for ((_, channel), values) in channels.zip(curves) {
            let (abscissa, unit) = (&channel.abscissa, format!("{} per {per}", channel.unit));
            for (at, value) in abscissa.points.iter().zip(values) {
                let names = [
                    condition.as_str(),
                    name,
                    &channel.name,
                    &unit,
                    &abscissa.name,
                    &abscissa.unit,
                ];
                let numbers = [field(Some(*at)), field(Some(f64::from(*value)))];
                writer.write_record(names.into_iter().chain(numbers.iter().map(String::as_str)))?;
            }
        }
    }
    Ok(writer.flush()?)
}
