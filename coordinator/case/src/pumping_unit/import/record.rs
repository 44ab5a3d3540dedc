//! Gauge record from the files of a data logger.
use super::{
    cleaning,
    logger::{self, Table},
    mapping::{CurveEntry, RecordMapping},
    paths::beside,
    turns::{Stretch, turns},
};
use crate::{
    document::{Document, DocumentStep},
    error::{CaseError, contradiction, damaged},
    pumping_unit::record::{CURVES, SPEED_TOLERANCE},
};
use protocol::pumping_unit::Sensor;
use std::{fmt::Write as _, path::Path};

/// Gauge record as text, with what its data sheet states about it.
#[derive(Debug, Default)]
pub(super) struct ConvertedRecord {
    /// Text of the record: a table in CSV.
    pub(super) csv: String,
    /// Mean speed of the crank over the whole turns [1/min].
    pub(super) speed_rpm: f64,
    pub(super) rate_hz: f64,
    pub(super) samples: usize,
    /// Number of samples that are missing by the time column.
    pub(super) lost: usize,
    /// Number of turns, rounded.
    pub(super) turns: usize,
    /// Resolution of the gauges \[MPa\].
    pub(super) resolution_mpa: Option<f64>,
    /// Remarks for the user: what was left out, and why.
    pub(super) notes: Vec<String>,
}

/// Crank speed and output grid of the case.
#[derive(Clone, Copy, Debug)]
pub(super) struct Condition {
    pub(super) speed_rpm: f64,
    pub(super) step_deg: f64,
}

/// One curve of the record: its name there, its sensor and its entry in the mapping.
struct Curve<'a> {
    name: &'static str,
    sensor: Sensor,
    entry: &'a CurveEntry,
    /// Factor from the numbers of the column to the unit of the record.
    factor: f64,
}

/// Longest block of samples that is averaged to one, as a share of the output step. It keeps 99.9 % of a
/// ripple of order 80 of the crank at a step of 0.5 deg.
const BLOCK: f64 = 0.25;

/// Imports the files of a mapping.
///
/// # Errors
/// Returns an error that names file, line and column, or the key of the mapping, of the first fault.
pub(super) fn import(
    document: &Document,
    condition: Condition,
) -> Result<ConvertedRecord, CaseError> {
    let mapping: RecordMapping = document.parse()?;
    document.within(
        "angle.uncertainty_deg",
        mapping.angle.uncertainty_deg,
        0.0..=90.0,
        "deg",
    )?;
    let angle = mapping.angle.angle(document)?;
    let curves = curves(document, &mapping)?;
    let mut wanted = vec![angle.column()];
    wanted.extend(curves.iter().map(|curve| curve.entry.column.as_str()));
    let mut tables: Vec<Table> = Vec::new();
    for file in &mapping.files {
        let path = beside(&document.path, file);
        let table = logger::read(&path, &mapping.table, Some(&mapping.time), &wanted)?;
        // a file that does not continue the one before is a recording of its own
        let apart = match tables.last_mut() {
            Some(before) => before.append(table),
            None => Some(table),
        };
        tables.extend(apart);
    }
    let mut record = Joined::new(curves.len());
    let mut result = ConvertedRecord::default();
    let (mut durations, mut missing) = (Vec::new(), vec![[0_usize; 2]; curves.len()]);
    for table in &mut tables {
        let turns = turns(table, &angle, 60.0 / condition.speed_rpm)?;
        for (place, curve) in curves.iter().enumerate() {
            let mut values = std::mem::take(&mut table.columns[place + 1]);
            cleaning::check(table, &curve.entry.column, &values)?;
            let step = cleaning::resolution(&values).map(|step| step * curve.factor.abs());
            missing[place][0] += values.iter().filter(|value| value.is_nan()).count();
            missing[place][1] += cleaning::remove_disturbed(&mut values);
            for value in &mut values {
                *value *= curve.factor;
            }
            if curve.sensor.is_gauge() && step > result.resolution_mpa {
                result.resolution_mpa = step;
            }
            table.columns[place + 1] = values;
        }
        let notes = turns.left_out.iter();
        result
            .notes
            .extend(notes.map(|note| format!("left out: {note}")));
        durations.extend(turns.durations_s);
        for stretch in &turns.stretches {
            record.append(table, stretch);
        }
    }
    if durations.is_empty() {
        return Err(no_turn(&tables, angle.column()));
    }
    let shown = curves.iter().zip(&missing);
    for (curve, [empty, disturbed]) in shown.filter(|(_, count)| **count != [0, 0]) {
        result.notes.push(format!(
            "column `{}`: {empty} missing and {disturbed} disturbed values; their rows are left out",
            curve.entry.column
        ));
    }
    result.speed_rpm = 60.0 * durations.len() as f64 / durations.iter().sum::<f64>();
    if (result.speed_rpm / condition.speed_rpm - 1.0).abs() > SPEED_TOLERANCE {
        return Err(contradiction(
            tables
                .first()
                .map_or(Path::new(""), |table| table.place(0).0),
            format!("the speed by `time` and column `{}`", angle.column()),
            format!("{:.3} /min", result.speed_rpm),
            format!("the condition has speed_rpm = {}", condition.speed_rpm),
            "take the files of this condition, correct `time` in the mapping, or correct the case",
        ));
    }
    record.thin_out(BLOCK * condition.step_deg, &mut result.notes);
    record.write(&curves, &mut result);
    Ok(result)
}

/// Creates the error for raw files without a whole turn.
fn no_turn(tables: &[Table], column: &str) -> CaseError {
    let first = tables.first().map(|table| table.place(0));
    let last = tables
        .last()
        .map(|table| table.place(table.lines.len().saturating_sub(1)));
    let (path, from) = first.unwrap_or((Path::new(""), 0));
    damaged(
        path,
        format!(
            "there is no whole turn of the crank by column `{column}` in lines {from} to {}",
            last.unwrap_or((path, 0)).1
        ),
        "record at least one whole turn, better ten; or correct `angle` in the mapping",
    )
}

/// Returns the standard deviation of the angle's zero that a mapping states \[deg\].
///
/// # Errors
/// Returns an error for a malformed mapping.
pub(super) fn uncertainty_deg(document: &Document) -> Result<f64, CaseError> {
    Ok(document.parse::<RecordMapping>()?.angle.uncertainty_deg)
}

/// Checks the curves of a mapping and computes their factors.
fn curves<'a>(
    document: &Document,
    mapping: &'a RecordMapping,
) -> Result<Vec<Curve<'a>>, CaseError> {
    let way = |name: &'a str, key: &'static str| {
        [
            DocumentStep::Key("curves"),
            DocumentStep::Key(name),
            DocumentStep::Key(key),
        ]
    };
    let names = CURVES.map(|(name, _)| name).join(", ");
    for (name, entry) in &mapping.curves {
        if !CURVES.iter().any(|(known, _)| known == name) {
            return Err(document.field(
                &way(name, "column")[..2],
                "{ .. }",
                format!("a curve of a record: {names}"),
                "correct the name, or remove the curve",
            ));
        }
        if !entry.factor.is_finite() || entry.factor.abs() < f64::MIN_POSITIVE {
            return Err(document.field(
                &way(name, "factor"),
                entry.factor,
                "a finite number other than 0",
                "state the factor on the numbers of the column, such as kN per volt",
            ));
        }
    }
    let known = CURVES.iter().filter_map(|(name, sensor)| {
        let entry = mapping.curves.get(*name)?;
        Some((*name, *sensor, entry))
    });
    let curve = |(name, sensor, entry): (&'static str, Sensor, &'a CurveEntry)| {
        let factor = factor(sensor, entry).map_err(|(key, allowed, help)| {
            document.field(
                &way(name, key),
                format!("\"{}\"", entry.unit),
                allowed,
                help,
            )
        })?;
        Ok(Curve {
            name,
            sensor,
            entry,
            factor,
        })
    };
    let curves = known.map(curve).collect::<Result<Vec<_>, CaseError>>()?;
    if curves.iter().any(|curve| curve.sensor.is_gauge()) {
        return Ok(curves);
    }
    Err(document.field(
        &[DocumentStep::Key("curves")],
        "{ .. }",
        "at least one of stress_1_mpa .. stress_4_mpa",
        "state the column of a gauge by the gauge's number",
    ))
}

/// Returns the factor from the numbers of a column to the unit of its curve; on failure the key at fault, what
/// is allowed and the remedy.
fn factor(
    sensor: Sensor,
    entry: &CurveEntry,
) -> Result<f64, (&'static str, &'static str, &'static str)> {
    let unit = logger::normal(&entry.unit).unwrap_or_default();
    let to = |other: &str| logger::factor(&unit, other);
    let plain = match sensor {
        Sensor::Position => to("m").ok_or("a unit of length: m, mm, in, ft"),
        Sensor::Torque => to("N.m").ok_or("a unit of torque: N.m, kN.m, lbf.ft, lbf.in"),
        Sensor::Gauge(_) => {
            let young = entry.young_gpa.map(|gpa| 1e3 * gpa);
            let strain = if unit == "mv/v" || unit == "mV/V" {
                let (Some(gauge), arms) = (entry.gauge_factor, entry.active_arms.unwrap_or(1.0))
                else {
                    return Err((
                        "unit",
                        "`gauge_factor` beside mV/V",
                        "state gauge_factor (2 of most foil gauges), and active_arms (1 unless stated, 2 of a \
                         half bridge, 4 of a full one)",
                    ));
                };
                Some(4e-3 / (gauge * arms))
            } else {
                to("m/m")
            };
            match (strain, young) {
                (Some(strain), Some(young)) => Ok(strain * young),
                (Some(_), None) => {
                    return Err((
                        "unit",
                        "`young_gpa` beside a unit of strain",
                        "state Young's modulus of the gauged part in GPa, 206 of structural steel",
                    ));
                }
                (None, _) if young.is_some() => {
                    return Err((
                        "unit",
                        "`young_gpa` only beside a unit of strain",
                        "remove young_gpa, or correct the unit: the two contradict each other",
                    ));
                }
                (None, _) => {
                    to("MPa").ok_or("a unit of strain or stress: um/m, mV/V, MPa, psi, ksi")
                }
            }
        }
    };
    plain
        .map(|factor| factor * entry.factor)
        .map_err(|allowed| {
            (
                "unit",
                allowed,
                "state the unit of the column's numbers, after `factor`",
            )
        })
}

/// Samples of all stretches, one after the other.
struct Joined {
    time_s: Vec<f64>,
    angle_deg: Vec<f64>,
    curves: Vec<Vec<f64>>,
    /// Angle at which the last whole turn ends, counted over all stretches \[deg\].
    end_deg: f64,
}

impl Joined {
    fn new(curves: usize) -> Self {
        Self {
            time_s: Vec::new(),
            angle_deg: Vec::new(),
            curves: vec![Vec::new(); curves],
            end_deg: 0.0,
        }
    }

    /// Appends the samples of a stretch that have all values. Between stretches the time runs on: what is
    /// left out has no place in the record.
    fn append(&mut self, table: &Table, stretch: &Stretch) {
        let [from, to] = stretch.whole_deg;
        let first = self.time_s.is_empty();
        while self
            .angle_deg
            .last()
            .is_some_and(|angle| *angle >= self.end_deg)
        {
            self.angle_deg.pop();
            self.time_s.pop();
            for curve in &mut self.curves {
                curve.truncate(self.time_s.len());
            }
        }
        let mut shift = None;
        for (&row, &angle) in stretch.rows.iter().zip(&stretch.angle_deg) {
            let values = || table.columns.iter().skip(1).map(|column| column[row]);
            if (angle < from && !first) || values().any(f64::is_nan) {
                continue;
            }
            let time = table.time_s[row];
            let shift = *shift.get_or_insert_with(|| {
                let step = median_step(&table.time_s);
                self.time_s.last().map_or(-time, |last| last + step - time)
            });
            self.time_s.push(time + shift);
            self.angle_deg.push(angle - from + self.end_deg);
            for (curve, value) in self.curves.iter_mut().zip(values()) {
                curve.push(value);
            }
        }
        self.end_deg += to - from;
    }

    /// Averages blocks of samples that are denser than the record needs; a block ends at a gap.
    fn thin_out(&mut self, block_deg: f64, notes: &mut Vec<String>) {
        let span = self.angle_deg.last().unwrap_or(&0.0) - self.angle_deg.first().unwrap_or(&0.0);
        let step_deg = span / self.angle_deg.len().max(1) as f64;
        let size = crate::pumping_unit::record::whole((block_deg / step_deg).floor());
        let Some(size) = usize::try_from(size).ok().filter(|size| *size > 1) else {
            return;
        };
        let step = median_step(&self.time_s);
        let mut from = 0;
        let mut blocks = Vec::new();
        for row in 1..=self.time_s.len() {
            let ends = row == self.time_s.len()
                || row - from == size
                || self.time_s[row] - self.time_s[row - 1] > 1.5 * step;
            if ends {
                // a block before a gap may be shorter, and then weighs less than its noise says
                if 2 * (row - from) >= size {
                    blocks.push(from..row);
                }
                from = row;
            }
        }
        let average = |values: &[f64]| -> Vec<f64> {
            let mean = |block: &std::ops::Range<usize>| {
                values[block.clone()].iter().sum::<f64>() / block.len() as f64
            };
            blocks.iter().map(mean).collect()
        };
        self.time_s = average(&self.time_s);
        self.angle_deg = average(&self.angle_deg);
        self.curves = self.curves.iter().map(|curve| average(curve)).collect();
        notes.push(format!(
            "every {size} samples are averaged to one: they are {step_deg:.4} deg of the crank apart"
        ));
    }

    /// Writes the samples as a table.
    fn write(&self, curves: &[Curve<'_>], result: &mut ConvertedRecord) {
        let step = median_step(&self.time_s);
        result.rate_hz = 1.0 / step;
        result.samples = self.time_s.len();
        let span = self.time_s.last().unwrap_or(&0.0) - self.time_s.first().unwrap_or(&0.0);
        let count = |value: f64| {
            let whole = crate::pumping_unit::record::whole(value.round());
            usize::try_from(whole).unwrap_or(usize::MAX)
        };
        result.lost = (count(span / step) + 1).saturating_sub(result.samples);
        let angles = self.angle_deg.last().unwrap_or(&0.0) - self.angle_deg.first().unwrap_or(&0.0);
        result.turns = count(angles / 360.0);
        let text = &mut result.csv;
        text.push_str("time_s,crank_deg");
        for curve in curves {
            let _infallible = write!(text, ",{}", curve.name);
        }
        text.push('\n');
        for (row, (time, angle)) in self.time_s.iter().zip(&self.angle_deg).enumerate() {
            let _infallible = write!(text, "{time:.5},{:.3}", angle.rem_euclid(360.0));
            for (curve, values) in curves.iter().zip(&self.curves) {
                let _infallible = match curve.sensor {
                    Sensor::Torque => write!(text, ",{:.2}", values[row]),
                    Sensor::Gauge(_) | Sensor::Position => write!(text, ",{:.5}", values[row]),
                };
            }
            text.push('\n');
        }
    }
}

/// Returns the median time between samples \[s\].
fn median_step(time_s: &[f64]) -> f64 {
    let mut steps: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() {
        return 0.0;
    }
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}
