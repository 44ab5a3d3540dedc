//! The samples of a gauge record: time, crank angle and stress columns, checked row by row.
use crate::{
    document::nearest,
    error::{CaseError, damaged},
    table::{CsvTable, clip},
};
use protocol::pumping_unit::Sensor;
use std::path::Path;

/// Names of the required columns of a record.
const COLUMNS: [&str; 2] = ["time_s", "crank_deg"];

/// Columns with measured curves and their sensors: gauges, at least one of which is required, then the
/// optional sensors that a diagnosis uses.
pub(in super::super) const CURVES: [(&str, Sensor); 6] = [
    ("stress_1_mpa", Sensor::Gauge(1)),
    ("stress_2_mpa", Sensor::Gauge(2)),
    ("stress_3_mpa", Sensor::Gauge(3)),
    ("stress_4_mpa", Sensor::Gauge(4)),
    ("polished_rod_position_m", Sensor::Position),
    ("crank_torque_nm", Sensor::Torque),
];

/// Columns of a record that are accepted but not used: the load is an input of the model and not an output to
/// compare with.
const IGNORED_COLUMNS: [&str; 1] = ["polished_rod_load_n"];

/// Samples of a gauge record, before resampling on the output grid.
#[derive(Debug)]
pub(in super::super) struct Samples {
    /// Crank angle unwrapped over the cycles: cycle x 360 + angle \[deg\]; never decreasing.
    pub(in super::super) angle_deg: Vec<f64>,
    /// Sensor and values of each recorded curve (MPa, m, N m), gauges first.
    pub(super) curves: Vec<(Sensor, Vec<f64>)>,
    /// Names of the record's unused columns, each with the most similar known column that the record lacks.
    pub(super) unused: Vec<(String, Option<&'static str>)>,
    /// Time of the first sample after each index pulse \[s\].
    pub(in super::super) pulses_s: Vec<f64>,
    /// Median time between samples \[s\].
    pub(in super::super) step_s: f64,
    /// Number of lost samples, from gaps in the time column.
    pub(in super::super) lost: u64,
    /// Median crank angle between samples \[deg\].
    pub(super) step_deg: f64,
}

impl Samples {
    /// Reads and checks the columns of a gauge record.
    ///
    /// # Errors
    /// Returns an error for any fault of the table; times that repeat or decrease; angles outside 0 to 360 or
    /// decreasing; no gauge; stress that is not in MPa judging by its magnitude; a gauge without signal.
    pub(in super::super) fn read(path: &Path, bytes: &[u8]) -> Result<Self, CaseError> {
        let table = CsvTable::read_with(path, bytes, &COLUMNS, &CURVES.map(|(name, _)| name))?;
        let [time, crank, rest @ ..] = table.columns.as_slice() else {
            return Err(damaged(path, "no columns", "copy it again"));
        };
        let names = table.names.iter().skip(COLUMNS.len());
        let sensors = names.filter_map(|name| CURVES.iter().find(|(known, _)| known == name));
        let sensors = sensors.map(|(_, sensor)| *sensor);
        let curves: Vec<(Sensor, Vec<f64>)> = sensors.zip(rest.iter().cloned()).collect();
        let gauges = curves
            .iter()
            .filter(|(sensor, _)| sensor.is_gauge())
            .count();
        if gauges == 0 {
            return Err(damaged(
                path,
                "no column of a gauge: stress_1_mpa, stress_2_mpa, stress_3_mpa or stress_4_mpa",
                "a record needs one gauge at least; name its column by the gauge's number",
            ));
        }
        if time.len() < 4 {
            return Err(damaged(
                path,
                format!("the record has {} rows: no whole revolution", time.len()),
                "record at least one revolution from index pulse to index pulse, better five or more",
            ));
        }
        check_time(path, &table, time)?;
        let (angle_deg, pulses_s) = unwrap_angle(path, &table, time, crank)?;
        for (index, (_, values)) in curves.iter().take(gauges).enumerate() {
            check_stress(path, &table, index + COLUMNS.len(), values)?;
        }
        let absent = || CURVES.iter().map(|(name, _)| *name);
        let absent = || absent().filter(|name| !table.names.iter().any(|read| read == name));
        let unused = table.others.iter();
        let unused = unused.filter(|name| !IGNORED_COLUMNS.contains(&name.as_str()));
        let unused = unused.map(|name| (clip(name, 40), nearest(name, absent())));
        let step_s = median(time.iter().zip(time.iter().skip(1)).map(|(a, b)| b - a));
        let step_deg = median(
            angle_deg
                .iter()
                .zip(angle_deg.iter().skip(1))
                .map(|(a, b)| b - a),
        );
        let lost = time
            .iter()
            .zip(time.iter().skip(1))
            .map(|(a, b)| whole(((b - a) / step_s).round() - 1.0))
            .sum();
        Ok(Self {
            angle_deg,
            curves,
            unused: unused.collect(),
            pulses_s,
            step_s,
            lost,
            step_deg,
        })
    }
}

/// Checks that the sample times of a gauge record ascend strictly.
fn check_time(path: &Path, table: &CsvTable, time: &[f64]) -> Result<(), CaseError> {
    for (row, (before, after)) in time.iter().zip(time.iter().skip(1)).enumerate() {
        if after <= before {
            let (what, help) = if after < before {
                (
                    "backwards",
                    "sort the rows by time, or cut the record where its clock was set",
                )
            } else {
                (
                    "the same time again",
                    "remove the repeated row, or correct its time stamp",
                )
            };
            return Err(table.cell(
                path,
                (row + 1, 0),
                format!("{after} s ({what})"),
                format!("more than the row before: {before} s"),
                help,
            ));
        }
    }
    Ok(())
}

/// Unwraps the crank angle over the index pulses, which appear as a decrease of more than half a turn;
/// returns the angles and the times of the pulses.
fn unwrap_angle(
    path: &Path,
    table: &CsvTable,
    time: &[f64],
    crank: &[f64],
) -> Result<(Vec<f64>, Vec<f64>), CaseError> {
    let mut angles: Vec<f64> = Vec::with_capacity(crank.len());
    let mut pulses = Vec::new();
    let mut before: Option<f64> = None;
    for (row, (&angle, &at)) in crank.iter().zip(time).enumerate() {
        if !(0.0..=360.0).contains(&angle) {
            return Err(table.cell(
                path,
                (row, 1),
                angle.to_string(),
                "0 to 360 deg from bottom dead centre",
                "count the crank angle from each index pulse, in degrees",
            ));
        }
        if let Some(last) = before {
            if last - angle > 180.0 {
                pulses.push(at);
            } else if angle < last {
                return Err(table.cell(
                    path,
                    (row, 1),
                    angle.to_string(),
                    format!("at least the row before ({last} deg), or a fall to 0 at the index pulse"),
                    "crank_deg must increase with time: reverse its sense, or remove the disturbed rows",
                ));
            }
        }
        before = Some(angle);
        angles.push(pulses.len() as f64 * 360.0 + angle);
    }
    Ok((angles, pulses))
}

/// Checks that the samples of a gauge have the magnitude of stress in MPa and vary.
fn check_stress(
    path: &Path,
    table: &CsvTable,
    column: usize,
    values: &[f64],
) -> Result<(), CaseError> {
    const ALLOWED: &str = "-2000 to 2000 MPa, varying by at least 0.1 MPa";
    let outside = |value: &f64| value.abs() > 2000.0;
    if let Some(row) = values.iter().position(outside) {
        let value = values.get(row).copied().unwrap_or_default();
        let many = values.iter().filter(|value| outside(value)).count() * 2 > values.len();
        let help = if many {
            "the whole column is that large: it looks like Pa or kPa; convert it to MPa"
        } else {
            "a spike of the amplifier: remove the row, lost samples are allowed"
        };
        return Err(table.cell(path, (row, column), value.to_string(), ALLOWED, help));
    }
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if highest - lowest < 0.1 {
        return Err(table.cell(
            path,
            (0, column),
            format!("{lowest} to {highest} over the whole record"),
            ALLOWED,
            "the column looks like GPa, or the gauge is dead: convert it, or leave the record out",
        ));
    }
    Ok(())
}

/// Returns the median (the upper one of an even number of values); 0 without values.
pub(in super::super) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

/// Converts a non-negative number that is whole up to rounding to an integer; negative numbers become 0.
pub(in super::super) fn whole(value: f64) -> u64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturating is what is wanted of a count"
    )]
    let count = value.max(0.0) as u64;
    count
}
