//! Gauge records: samples and data sheet in, one averaged turn on the output grid out.
//!
//! A record is cut into cycles at the index pulses, every whole cycle is resampled on the output
//! grid, and the cycles are averaged; the standard deviation between them is the noise model.
mod resample;
mod samples;
mod sheet;
#[cfg(test)]
mod tests;

use super::{
    error::{CaseError, contradiction, damaged},
    file,
    note::Note,
};
use discrepancy::record::Record;
use protocol::case::{GaugeRecord, GaugeTrace, TurnSense};
use samples::Samples;
use sheet::Sheet;
use std::path::{Path, PathBuf};

/// What a record is asked to agree with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Expected<'a> {
    /// Position of the condition in the case.
    pub(super) index: usize,
    /// Name of the condition, for messages.
    pub(super) condition: &'a str,
    /// Speed of the condition [1/min].
    pub(super) speed_rpm: f64,
    /// The case file, for messages.
    pub(super) case_file: &'a Path,
    /// Output grid \[deg\].
    pub(super) step_deg: f64,
    /// Sense in which the case's crank turns.
    pub(super) sense: TurnSense,
}

/// What was found in a record beside its curves.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordFacts {
    /// The file.
    pub path: PathBuf,
    /// Samples in the file.
    pub samples: usize,
    /// Samples that are missing in the time column.
    pub lost: u64,
    /// Samples per second \[Hz\].
    pub rate_hz: f64,
    /// Mean speed between the first and the last index pulse [1/min].
    pub speed_rpm: f64,
    /// Noise that the data sheet states, per sample \[MPa\].
    pub stated_noise_mpa: Option<f64>,
}

/// Reads the samples of a record alone, without its sheet and without a case; how many there are.
///
/// # Errors
/// Everything that makes the samples unusable, with row and column; `path` is only named.
pub fn count_samples(path: &Path, csv: &[u8]) -> Result<usize, CaseError> {
    Samples::read(path, csv).map(|samples| samples.angle_deg.len())
}

/// A record that was read.
#[derive(Debug)]
pub(super) struct Read {
    pub(super) record: GaugeRecord,
    /// Every cycle by itself, with what was recorded beside the gauges.
    pub(super) cycles: Record,
    pub(super) facts: RecordFacts,
    pub(super) notes: Vec<Note>,
}

/// Largest difference of speeds that is no contradiction \[1\]: belt creep and slip reach 3 %.
const SPEED_TOLERANCE: f64 = 0.05;

/// Reads a record and the data sheet beside it.
///
/// # Errors
/// Anything that makes the record unusable or contradicts its sheet or the case.
pub(super) fn read(path: &Path, expected: &Expected<'_>) -> Result<Read, CaseError> {
    let role = format!(
        "the gauge record of condition `{}` in {}",
        expected.condition,
        expected.case_file.display()
    );
    let packed = path
        .extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("gz"));
    let bytes = if packed {
        file::read_gzip(path, &role)?
    } else {
        file::read(path, &role)?
    };
    let sheet_path = sheet_path(path);
    let (sheet, document, mut notes) = Sheet::read(
        &sheet_path,
        &format!("the data sheet of the record {}", path.display()),
    )?;
    let stated = sheet.strokes_per_minute;
    if (stated / expected.speed_rpm - 1.0).abs() > SPEED_TOLERANCE {
        return Err(contradiction(
            &document.path,
            "`strokes_per_minute`",
            format!("{stated} /min"),
            speed_of(expected),
            "take the record of this condition, or correct the speed that is wrong",
        ));
    }
    if let Some(stated) = sheet.sense()
        && stated != expected.sense
    {
        return Err(contradiction(
            &document.path,
            "`crank.sense`",
            stated.to_string(),
            format!(
                "{} has crank.sense = \"{}\"",
                expected.case_file.display(),
                expected.sense
            ),
            "both are seen with the well on the right: correct the one that is wrong",
        ));
    }
    let samples = Samples::read(path, &bytes)?;
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
    let record = average(path, &cycles, expected.step_deg)?;
    remark(path, &cycles, &samples, &facts, expected, &mut notes);
    let stated = sheet.stated(&cycles.channels, samples.step_deg / expected.step_deg);
    Ok(Read {
        record,
        cycles: Record {
            condition: expected.index,
            channels: cycles.channels,
            cycles: cycles.single,
            stated,
        },
        facts,
        notes,
    })
}

/// The data sheet of a record: the same name with the ending `.toml`.
fn sheet_path(record: &Path) -> PathBuf {
    let name = record.file_name().unwrap_or_default().to_string_lossy();
    let stem = name.trim_end_matches(".gz").trim_end_matches(".csv");
    record.with_file_name(format!("{stem}.toml"))
}

/// The case's speed, for messages.
fn speed_of(expected: &Expected<'_>) -> String {
    format!(
        "condition `{}` of {} has speed_rpm = {}",
        expected.condition,
        expected.case_file.display(),
        expected.speed_rpm
    )
}

/// What is told about a record; the speed is that between index pulses where there are two.
fn facts(path: &Path, samples: &Samples, sheet: &Sheet) -> RecordFacts {
    let speed_rpm = match samples.pulses_s.as_slice() {
        [first, .., last] => 60.0 * (samples.pulses_s.len() - 1) as f64 / (last - first),
        _ => samples.step_deg / samples.step_s / 6.0,
    };
    RecordFacts {
        path: path.to_owned(),
        samples: samples.angle_deg.len(),
        lost: samples.lost,
        rate_hz: 1.0 / samples.step_s,
        speed_rpm,
        stated_noise_mpa: sheet.gauges.noise_rms_mpa,
    }
}

/// The measured speed is that of the condition.
fn check_speed(
    path: &Path,
    samples: &Samples,
    facts: &RecordFacts,
    expected: &Expected<'_>,
) -> Result<(), CaseError> {
    if (facts.speed_rpm / expected.speed_rpm - 1.0).abs() <= SPEED_TOLERANCE {
        return Ok(());
    }
    Err(contradiction(
        path,
        format!(
            "the speed by {} index pulses (`crank_deg`, `time_s`)",
            samples.pulses_s.len()
        ),
        format!("{:.3} /min", facts.speed_rpm),
        speed_of(expected),
        "take the record of this condition, or correct the speed that is wrong",
    ))
}

/// Sampling and counts are those of the data sheet.
fn check_sheet(
    path: &Path,
    samples: &Samples,
    sheet: &Sheet,
    sheet_path: &Path,
    facts: &RecordFacts,
    notes: &mut Vec<Note>,
) -> Result<(), CaseError> {
    if (facts.rate_hz / sheet.sample_rate_hz - 1.0).abs() > 0.02 {
        return Err(contradiction(
            path,
            "the sampling by `time_s`",
            format!("{:.2} Hz (every {:.5} s)", facts.rate_hz, samples.step_s),
            format!(
                "{}: sample_rate_hz = {}",
                sheet_path.display(),
                sheet.sample_rate_hz
            ),
            "time_s must be in seconds; correct the sheet if the record was sampled at another rate",
        ));
    }
    if let Some(stated) = sheet.samples_recorded
        && stated != facts.samples as u64
    {
        return Err(contradiction(
            path,
            "the number of rows",
            facts.samples.to_string(),
            format!("{}: samples_recorded = {stated}", sheet_path.display()),
            "the record is cut off or belongs to another sheet: copy both again",
        ));
    }
    if let Some(stated) = sheet.samples_lost
        && stated != samples.lost
    {
        notes.push(Note {
            path: path.to_owned(),
            text: format!(
                "the time column lacks {} samples, the data sheet says {stated}",
                samples.lost
            ),
        });
    }
    Ok(())
}

/// The averaged record; every grid angle must have a value.
fn average(
    path: &Path,
    cycles: &resample::Cycles,
    step_deg: f64,
) -> Result<GaugeRecord, CaseError> {
    let turn_deg = resample::grid(step_deg);
    let mut gauges = Vec::new();
    for (number, (mean, spread)) in (1..).zip(cycles.mean.iter().zip(&cycles.spread)) {
        if let Some(first) = mean.iter().position(Option::is_none) {
            let length = mean
                .iter()
                .skip(first)
                .take_while(|value| value.is_none())
                .count();
            let from = turn_deg.get(first).copied().unwrap_or_default();
            return Err(damaged(
                path,
                format!(
                    "no cycle has samples of `crank_deg` near {from} deg: a gap of about {:.1} deg \
                     on every cycle; allowed: no angle that is missing in all cycles",
                    length as f64 * step_deg
                ),
                "repeat the measurement, or add a cycle that covers the gap",
            ));
        }
        gauges.push(GaugeTrace {
            gauge: number,
            mean_mpa: mean.iter().map(|value| value.unwrap_or_default()).collect(),
            spread_mpa: spread.clone(),
        });
    }
    Ok(GaugeRecord {
        turn_deg,
        cycles: cycles.whole.len(),
        gauges,
    })
}

/// What the user should know.
fn remark(
    path: &Path,
    cycles: &resample::Cycles,
    samples: &Samples,
    facts: &RecordFacts,
    expected: &Expected<'_>,
    notes: &mut Vec<Note>,
) {
    let mut note = |text: String| {
        notes.push(Note {
            path: path.to_owned(),
            text,
        });
    };
    match cycles.whole.len() {
        1 => note(
            "one whole cycle only: there is no spread between cycles, so no noise model".to_owned(),
        ),
        few @ 2..=4 => note(format!(
            "{few} whole cycles: the noise model is rough, ten are better"
        )),
        _ => {}
    }
    if samples.lost > 0 {
        let total = samples.lost as f64 + facts.samples as f64;
        note(format!(
            "{} of {total:.0} samples are lost ({:.1} %); {} grid angles lack a cycle",
            samples.lost,
            100.0 * samples.lost as f64 / total,
            cycles.gaps
        ));
    }
    let off = facts.speed_rpm / expected.speed_rpm - 1.0;
    if off.abs() > 0.01 {
        note(format!(
            "the measured speed is {:.3} /min, {:+.1} % off the condition's",
            facts.speed_rpm,
            100.0 * off
        ));
    }
}

/// From the first to the last angle.
fn span(angles: &[f64]) -> f64 {
    match (angles.first(), angles.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    }
}
