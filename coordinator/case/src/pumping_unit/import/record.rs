//! Gauge record from the files of a data logger.
use super::{
    cleaning,
    logger::{self, Columns, Table},
    mapping::{CurveEntry, RecordMapping},
    paths::beside,
    turns::{Segment, turns},
};
use crate::{
    document::{Document, DocumentStep},
    error::{CaseError, contradiction, damaged},
    pumping_unit::record::{CURVES, SPEED_TOLERANCE, median, whole},
};
use protocol::pumping_unit::Sensor;
use std::{fmt::Write as _, path::PathBuf};

/// Gauge record as text, with what its data sheet states about it.
#[derive(Debug, Default)]
pub(super) struct ConvertedRecord {
    /// Text of the record: a table in CSV.
    pub(super) csv: String,
    /// Mean speed of the crank over the whole turns [1/min].
    pub(super) speed_rpm: f64,
    /// Resolution of the gauges \[MPa\].
    pub(super) resolution_mpa: Option<f64>,
    /// Standard deviation of the angle's zero \[deg\].
    pub(super) uncertainty_deg: f64,
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
    let clock = mapping.time.clock(document)?;
    check_files(document, &mapping)?;
    let mut table: Option<Table> = None;
    for file in &mapping.files {
        let path = beside(&document.path, file);
        let next = logger::read(&path, &mapping.table, Some(clock), &wanted)?;
        match &mut table {
            Some(table) => table.append(next),
            None => table = Some(next),
        }
    }
    let Some(mut table) = table else {
        return Err(document.field(
            &[DocumentStep::Key("files")],
            "[]",
            "one file at least",
            "name the raw files",
        ));
    };
    let mut result = ConvertedRecord {
        uncertainty_deg: mapping.angle.uncertainty_deg,
        ..ConvertedRecord::default()
    };
    clean(&mut table, &curves, &mut result)?;
    let has_all = |row: &usize| {
        table
            .columns
            .iter()
            .skip(1)
            .all(|column| !column[*row].is_nan())
    };
    let valid: Vec<usize> = (0..table.lines.len()).filter(has_all).collect();
    let turns = turns(&table, &valid, &angle, 60.0 / condition.speed_rpm)?;
    let notes = turns.left_out.iter();
    result
        .notes
        .extend(notes.map(|note| format!("left out: {note}")));
    let durations = turns.durations_s;
    if durations.is_empty() {
        return Err(no_turn(&table, angle.column()));
    }
    let mut record = Joined::new(curves.len(), &table);
    for segment in &turns.segments {
        record.append(&table, segment);
    }
    result.speed_rpm = 60.0 * durations.len() as f64 / durations.iter().sum::<f64>();
    if (result.speed_rpm / condition.speed_rpm - 1.0).abs() > SPEED_TOLERANCE {
        return Err(contradiction(
            table.place(0).0,
            format!("the speed by `time` and column `{}`", angle.column()),
            format!("{:.3} /min", result.speed_rpm),
            format!("the condition has speed_rpm = {}", condition.speed_rpm),
            "take the files of this condition, correct `time` in the mapping, or correct the case",
        ));
    }
    record.decimate(BLOCK * condition.step_deg, &mut result.notes);
    record.write(&curves, &mut result);
    Ok(result)
}

/// Checks and cleans the curves of a table, whose columns follow that of the angle, and converts them to the
/// units of the record.
fn clean(
    table: &mut Table,
    curves: &[Curve<'_>],
    result: &mut ConvertedRecord,
) -> Result<(), CaseError> {
    for (place, curve) in (1..).zip(curves) {
        let name = &curve.entry.column;
        let mut values = std::mem::take(&mut table.columns[place]);
        let missing = values.iter().filter(|value| value.is_nan()).count();
        if 2 * missing > values.len() {
            return Err(table.fault(
                0,
                name,
                format!(
                    "a value in {} of {} rows",
                    values.len() - missing,
                    values.len()
                ),
                "a value in at least half of the rows",
                "remove the column from `curves` in the mapping: rows without it are left out",
            ));
        }
        let outliers = cleaning::remove_outliers(&mut values);
        cleaning::check(table, name, &values)?;
        let step = cleaning::resolution(&values).map(|step| step * curve.factor.abs());
        if curve.sensor.is_gauge() && step > result.resolution_mpa {
            result.resolution_mpa = step;
        }
        if missing + outliers > 0 {
            result.notes.push(format!(
                "column `{name}`: {missing} missing values and {outliers} outliers; their rows are left out"
            ));
        }
        for value in &mut values {
            *value *= curve.factor;
        }
        table.columns[place] = values;
    }
    Ok(())
}

/// Checks that no file is named twice, and that all have the columns of the first one.
fn check_files(document: &Document, mapping: &RecordMapping) -> Result<(), CaseError> {
    let paths: Vec<PathBuf> = mapping
        .files
        .iter()
        .map(|file| beside(&document.path, file))
        .collect();
    let Some(first) = paths.first() else {
        return Ok(());
    };
    let columns = Columns::read(first, &mapping.table)?;
    for (at, path) in paths.iter().enumerate().skip(1) {
        if paths.iter().take(at).any(|other| other == path) {
            return Err(damaged(
                path,
                "`files` of the mapping names it twice",
                "name every raw file once",
            ));
        }
        let own = Columns::read(path, &mapping.table)?;
        let pairs = columns
            .names
            .iter()
            .zip(&columns.units)
            .zip(own.names.iter().zip(&own.units));
        let differs = pairs.into_iter().find(|(one, other)| one != other);
        if let Some(((name, unit), (other, other_unit))) = differs {
            let of = |name: &str, unit: &Option<String>| {
                unit.as_ref()
                    .map_or_else(|| name.to_owned(), |unit| format!("{name} in {unit}"))
            };
            return Err(contradiction(
                path,
                "a column",
                format!("`{}`", of(other, other_unit)),
                format!("{} has `{}` there", first.display(), of(name, unit)),
                "all files of a record have one layout, stated by `table`: bring copies of them to the same one",
            ));
        }
    }
    Ok(())
}

/// Creates the error for raw files without a whole turn.
fn no_turn(table: &Table, column: &str) -> CaseError {
    let (path, from) = table.place(0);
    let (_, to) = table.place(table.lines.len().saturating_sub(1));
    damaged(
        path,
        format!(
            "there is no whole turn of the crank by column `{column}` in lines {from} to {to} of the file{}",
            if table.files.len() > 1 { "s" } else { "" }
        ),
        "record at least one whole turn, better ten; or correct `angle` in the mapping",
    )
}

/// Checks the curves of a mapping and computes their factors.
fn curves<'a>(
    document: &Document,
    mapping: &'a RecordMapping,
) -> Result<Vec<Curve<'a>>, CaseError> {
    let keys = |name: &'a str, key: &'static str| {
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
                &keys(name, "column")[..2],
                "{ .. }",
                format!("a curve of a record: {names}"),
                "correct the name, or remove the curve",
            ));
        }
        let ranges = [
            ("young_gpa", entry.young_gpa, 0.1..=1.0e3, "GPa"),
            ("gauge_factor", entry.gauge_factor, 0.5..=500.0, "1"),
            ("active_arms", entry.active_arms, 1.0..=4.0, "1"),
        ];
        for (key, value, range, unit) in ranges {
            if let Some(value) = value {
                document.within(&format!("curves.{name}.{key}"), value, range, unit)?;
            }
        }
        let same =
            |(other, own): &(&String, &CurveEntry)| *other < name && own.column == entry.column;
        if let Some((other, _)) = mapping.curves.iter().find(same) {
            return Err(document.field(
                &keys(name, "column"),
                format!("\"{}\"", entry.column),
                format!("another column than that of {other}"),
                "state the column of each curve; the second one of a name is `NAME#2`",
            ));
        }
        if !entry.factor.is_finite() || entry.factor.abs() < f64::MIN_POSITIVE {
            return Err(document.field(
                &keys(name, "factor"),
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
                &keys(name, key),
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
    let gauge = sensor.is_gauge();
    let bridge = gauge && unit.eq_ignore_ascii_case("mV/V");
    if !bridge && (entry.gauge_factor.is_some() || entry.active_arms.is_some()) {
        return Err((
            "unit",
            "`gauge_factor` and `active_arms` only beside mV/V",
            "remove them: the amplifier has converted the bridge's signal already",
        ));
    }
    if !gauge && entry.young_gpa.is_some() {
        return Err(("unit", "`young_gpa` only with gauges", "remove young_gpa"));
    }
    let plain = match sensor {
        Sensor::Position => to("m").ok_or("a unit of length: m, mm, in, ft"),
        Sensor::Torque => to("N.m").ok_or("a unit of torque: N.m, kN.m, lbf.ft, lbf.in"),
        Sensor::Gauge(_) => {
            let young = entry.young_gpa.map(|gpa| 1e3 * gpa);
            let strain = if bridge {
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

/// Samples of all segments, one after the other.
struct Joined {
    time_s: Vec<f64>,
    angle_deg: Vec<f64>,
    curves: Vec<Vec<f64>>,
    /// Sample at which each segment begins.
    starts: Vec<usize>,
    /// Angle at which the last whole turn ends, counted over all segments \[deg\].
    end_deg: f64,
    /// Median time between samples \[s\].
    step_s: f64,
}

impl Joined {
    fn new(curves: usize, table: &Table) -> Self {
        Self {
            time_s: Vec::new(),
            angle_deg: Vec::new(),
            curves: vec![Vec::new(); curves],
            starts: Vec::new(),
            end_deg: 0.0,
            step_s: median(table.time_s.windows(2).map(|pair| pair[1] - pair[0])),
        }
    }

    /// Appends the samples of a segment. Between segments the time runs on: what is left out has no place in
    /// the record.
    fn append(&mut self, table: &Table, segment: &Segment) {
        let [from, to] = segment.whole_deg;
        let first = self.time_s.is_empty();
        while self
            .angle_deg
            .last()
            .is_some_and(|angle| *angle >= self.end_deg)
        {
            self.angle_deg.pop();
            self.time_s.pop();
        }
        for curve in &mut self.curves {
            curve.truncate(self.time_s.len());
        }
        self.starts.push(self.time_s.len());
        let last = self.time_s.last().copied();
        let mut shift = None;
        for (&row, &angle) in segment.rows.iter().zip(&segment.angle_deg) {
            if angle < from && !first {
                continue;
            }
            let time = table.time_s[row];
            let shift =
                *shift.get_or_insert_with(|| last.map_or(-time, |last| last + self.step_s - time));
            self.time_s.push(time + shift);
            self.angle_deg.push(angle - from + self.end_deg);
            for (curve, column) in self.curves.iter_mut().zip(table.columns.iter().skip(1)) {
                curve.push(column[row]);
            }
        }
        self.end_deg += to - from;
    }

    /// Averages blocks of samples that are denser than the record needs; a block ends at a gap.
    fn decimate(&mut self, block_deg: f64, notes: &mut Vec<String>) {
        let span = self.angle_deg.last().unwrap_or(&0.0) - self.angle_deg.first().unwrap_or(&0.0);
        let step_deg = span / self.angle_deg.len().max(1) as f64;
        let size = whole((block_deg / step_deg).floor());
        let Some(size) = usize::try_from(size).ok().filter(|size| *size > 1) else {
            return;
        };
        let mut from = 0;
        let mut blocks = Vec::new();
        for row in 1..=self.time_s.len() {
            let ends = row == self.time_s.len()
                || row - from == size
                || self.time_s[row] - self.time_s[row - 1] > 1.5 * self.step_s
                || self.starts.binary_search(&row).is_ok();
            if ends {
                // the mean of much fewer samples would be noisier than the record says
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
