//! CSV files with the data behind the figures of an identification. Numbers have full precision.
use super::subject::IdentificationInput;
use crate::number::field;
use crate::words::condition_name;
use std::io::Write;

/// Writes the likelihood profiles: one row per unknown and point.
///
/// # Errors
/// [`csv::Error`] when the writer fails.
pub(super) fn profiles(
    to: impl Write,
    subject: &IdentificationInput<'_>,
) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_writer(to);
    writer.write_record(["unknown", "unit", "value", "rise"])?;
    for own in &subject.identified.unknowns {
        for [value, rise] in &own.profile {
            let numbers = [field(Some(*value)), field(Some(*rise))];
            let [value, rise] = &numbers;
            writer.write_record([&own.name, &own.unit, value, rise])?;
        }
    }
    Ok(writer.flush()?)
}

/// Writes the prediction bands: one row per condition, channel and point.
///
/// # Errors
/// [`csv::Error`] when the writer fails.
pub(super) fn bands(to: impl Write, subject: &IdentificationInput<'_>) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_writer(to);
    writer.write_record([
        "condition",
        "channel",
        "unit",
        "at",
        "likeliest",
        "low",
        "high",
    ])?;
    for band in &subject.identified.bands {
        let condition = condition_name(subject.case, band.condition);
        let channels = subject.case.channels_of(band.condition).zip(&band.channels);
        for ((_, channel), curve) in channels {
            for (k, at) in channel.abscissa.points.iter().enumerate() {
                let of = |values: &[f64]| field(values.get(k).copied());
                writer.write_record([
                    condition.clone(),
                    channel.name.clone(),
                    channel.unit.clone(),
                    field(Some(*at)),
                    of(&curve.likeliest),
                    of(&curve.low),
                    of(&curve.high),
                ])?;
            }
        }
    }
    Ok(writer.flush()?)
}
