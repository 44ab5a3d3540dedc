//! Checks that a record, its data sheet and the case agree, and notes for the user.
use super::{resample, samples::Samples, sheet::Sheet};
use crate::{
    document::Document,
    error::{CaseError, contradiction},
    note::Note,
};
use protocol::pumping_unit::TurnSense;
use std::path::{Path, PathBuf};

/// Values of the case with which a record must agree.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Expected<'a> {
    /// Index of the condition in the case.
    pub(in super::super) index: usize,
    pub(in super::super) condition: &'a str,
    /// Crank speed that the case states for the record's condition [1/min].
    pub(in super::super) speed_rpm: f64,
    /// Path of the case file, for messages.
    pub(in super::super) case_file: &'a Path,
    /// Angular step of the grid on which curves are compared \[deg\].
    pub(in super::super) step_deg: f64,
    /// Direction of rotation of the crank as stated in the case.
    pub(in super::super) sense: TurnSense,
}

/// Facts about a record apart from its curves.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordFacts {
    /// Path of the record's file.
    pub path: PathBuf,
    /// Number of samples in the record's file.
    pub samples: usize,
    /// Number of samples missing according to the time column.
    pub lost: u64,
    /// Sampling rate of the record \[Hz\].
    pub rate_hz: f64,
    /// Mean crank speed between the first and the last index pulse [1/min].
    pub speed_rpm: f64,
    /// Standard deviation of the noise of one sample that the data sheet states \[MPa\].
    pub stated_noise_mpa: Option<f64>,
    /// Names of the record's columns that are not used.
    pub unused: Vec<String>,
}

/// Relative tolerance between stated and measured speed \[1\]: belt creep and slip reach 3 %.
pub(in super::super) const SPEED_TOLERANCE: f64 = 0.05;

/// Checks that a data sheet belongs to the condition.
///
/// # Errors
/// Returns an error for another speed or the opposite sense of crank rotation.
pub(super) fn check_stated(
    sheet: &Sheet,
    document: &Document,
    expected: &Expected<'_>,
) -> Result<(), CaseError> {
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
    if let Some(stated) = sheet.sense(document)?
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
    Ok(())
}

/// Returns a phrase that states condition, case file and crank speed, for messages.
pub(super) fn speed_of(expected: &Expected<'_>) -> String {
    format!(
        "condition `{}` of {} has speed_rpm = {}",
        expected.condition,
        expected.case_file.display(),
        expected.speed_rpm
    )
}

/// Collects facts about a record, such as its sampling rate and crank speed; the speed is measured between
/// index pulses if there are at least two.
pub(super) fn facts(path: &Path, samples: &Samples, sheet: &Sheet) -> RecordFacts {
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
        unused: samples
            .unused
            .iter()
            .map(|(name, _)| name.clone())
            .collect(),
    }
}

/// Checks that the measured speed is that of the condition, within [`SPEED_TOLERANCE`].
pub(super) fn check_speed(
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

/// Checks that sampling rate and sample counts match the data sheet; a different number of lost samples is
/// only a note.
pub(super) fn check_sheet(
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

/// Adds notes for the user: unused columns, few cycles, lost samples and a deviating speed.
pub(super) fn add_notes(
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
    for (column, near) in &samples.unused {
        let near = near.map(|near| format!(": did you mean `{near}`?"));
        let near = near.unwrap_or_default();
        note(format!("column `{column}` is not used{near}"));
    }
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
