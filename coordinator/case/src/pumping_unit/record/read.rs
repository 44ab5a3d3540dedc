//! Reading of a record, from its files to the averaged turn.
use super::{
    agreement::{Expected, RecordFacts, add_notes, check_sheet, check_speed, check_stated, facts},
    resample,
    samples::Samples,
    sheet::Sheet,
};
use crate::{
    document::Document,
    error::{CaseError, Faults, damaged},
    file,
    note::Note,
};
use protocol::case::{Channel, ChannelRecord};
use protocol::pumping_unit::Sensor;
use record::{Record, Recorded};
use std::path::{Path, PathBuf};

/// Reads the samples of a record alone, without data sheet and case; returns their number. `path` is used
/// only in messages.
///
/// # Errors
/// Returns everything that makes the samples unusable, with row and column.
pub fn count_samples(path: &Path, csv: &[u8]) -> Result<usize, CaseError> {
    Samples::read(path, csv).map(|samples| samples.angle_deg.len())
}

/// Gauge record of a working condition as read from its files.
#[derive(Debug)]
pub(in super::super) struct GaugeRecord {
    /// Channels of all sensors of the condition, with the measured records of the gauges.
    pub(in super::super) channels: Vec<Channel>,
    /// Record with each cycle separate, including channels recorded in addition to the gauges.
    pub(in super::super) cycles: Record,
    pub(in super::super) facts: RecordFacts,
    pub(in super::super) notes: Vec<Note>,
}

/// Reads a record and the data sheet in the same folder.
///
/// # Errors
/// Returns everything that makes the record unusable or contradicts its sheet or the case.
pub(in super::super) fn read(
    path: &Path,
    expected: &Expected<'_>,
) -> Result<GaugeRecord, CaseError> {
    let role = format!(
        "the gauge record of condition `{}` in {}",
        expected.condition,
        expected.case_file.display()
    );
    let mut faults = Faults::default();
    let bytes = faults.take(if file::is_packed(path) {
        file::read_gzip(path, &role)
    } else {
        file::read(path, &role)
    });
    let role = format!("the data sheet of the record {}", path.display());
    let sheet = faults.take(
        Document::read(&sheet_path(path), &role).and_then(|document| {
            Sheet::of(&document)?;
            Ok(document)
        }),
    );
    faults.end()?;
    let (Some(bytes), Some(document)) = (bytes, sheet) else {
        return Err(damaged(path, "it cannot be read", "copy it again"));
    };
    of(path, &bytes, &document, expected)
}

/// Reads a record from its bytes and its data sheet.
///
/// # Errors
/// As [`read`].
pub(in super::super) fn of(
    path: &Path,
    bytes: &[u8],
    document: &Document,
    expected: &Expected<'_>,
) -> Result<GaugeRecord, CaseError> {
    let (sheet, mut notes) = Sheet::of(document)?;
    check_stated(&sheet, document, expected)?;
    let samples = Samples::read(path, bytes)?;
    let facts = facts(path, &samples, &sheet);
    check_speed(path, &samples, &facts, expected)?;
    check_sheet(path, &samples, &sheet, &document.path, &facts, &mut notes)?;
    let cycles = resample::cycles(&samples, expected.step_deg);
    if cycles.whole.is_empty() {
        return Err(damaged(
            path,
            format!(
                "the record has no whole revolution: {} index pulses, {:.0} deg of crank angle",
                samples.pulses_s.len(),
                span(&samples.angle_deg)
            ),
            "record at least one revolution from index pulse to index pulse, better five or more",
        ));
    }
    let mut channels = channels(expected.index, expected.step_deg);
    for (channel, sensor) in channels.iter_mut().zip(Sensor::ALL) {
        channel.noise = sheet.noise(sensor);
    }
    average(path, &cycles, &mut channels, expected.step_deg)?;
    add_notes(path, &cycles, &samples, &facts, expected, &mut notes);
    let places = Sensor::ALL.iter().zip(&channels).enumerate();
    let recorded = places
        .filter(|(_, (sensor, _))| cycles.channels.contains(sensor))
        .map(|(curve, (sensor, channel))| Recorded {
            correlation: sheet.correlation(samples.step_deg / expected.step_deg),
            scored: sensor.is_gauge(),
            ..Recorded::new(curve, channel)
        });
    Ok(GaugeRecord {
        cycles: Record {
            condition: expected.index,
            channels: recorded.collect(),
            cycles: cycles.single,
            held_out: false,
            stated: sheet.stated(&cycles.channels),
        },
        channels,
        facts,
        notes,
    })
}

/// Returns the channels of all sensors under a condition on the output grid, without measured records.
pub(in super::super) fn channels(condition: usize, step_deg: f64) -> Vec<Channel> {
    let turn_deg = resample::grid(step_deg);
    let channel = |sensor: Sensor| sensor.channel(condition, turn_deg.clone());
    Sensor::ALL.map(channel).into()
}

/// Returns the path of a record's data sheet: the same name with the extension `.toml`.
pub(in super::super) fn sheet_path(record: &Path) -> PathBuf {
    let name = record.file_name().unwrap_or_default().to_string_lossy();
    let stem = name.trim_end_matches(".gz").trim_end_matches(".csv");
    record.with_file_name(format!("{stem}.toml"))
}

/// Stores the averaged records in the recorded channels; every grid angle must have a value.
fn average(
    path: &Path,
    cycles: &resample::Cycles,
    channels: &mut [Channel],
    step_deg: f64,
) -> Result<(), CaseError> {
    let averaged = cycles.mean.iter().zip(&cycles.spread);
    for (sensor, (mean, spread)) in cycles.channels.iter().zip(averaged) {
        let place = Sensor::ALL.iter().position(|own| own == sensor);
        let Some(channel) = place.and_then(|at| channels.get_mut(at)) else {
            continue;
        };
        if let Some(first) = mean.iter().position(Option::is_none) {
            let gap = mean.iter().skip(first);
            let length = gap.take_while(|value| value.is_none()).count();
            let from = channel.abscissa.points.get(first).copied();
            return Err(damaged(
                path,
                format!(
                    "no cycle has samples of `crank_deg` near {} deg: a gap of about {:.1} deg on \
                     every cycle; allowed: no angle that is missing in all cycles",
                    from.unwrap_or_default(),
                    length as f64 * step_deg
                ),
                "repeat the measurement, or add a cycle that covers the gap",
            ));
        }
        channel.record = Some(ChannelRecord {
            cycles: cycles.whole.len(),
            mean: mean.iter().map(|value| value.unwrap_or_default()).collect(),
            spread: spread.clone(),
        });
    }
    Ok(())
}

/// Returns the difference between the last and the first of a list of angles.
fn span(angles: &[f64]) -> f64 {
    match (angles.first(), angles.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    }
}
