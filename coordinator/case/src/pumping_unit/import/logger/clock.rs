//! Times of the rows of a table: elapsed times, dates and clocks, or a sampling rate.
use super::{columns::Columns, layout::Layout, unit};
use crate::{
    document::{Document, DocumentStep},
    error::CaseError,
};
use jiff::{fmt::strtime::BrokenDownTime, tz::TimeZone};
use serde::{Deserialize, Serialize};

/// Statement of the time of each row of a table: a number in `column`; date and clock time in `columns`; or
/// the sampling rate.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Time {
    /// Name of the column with a number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) column: Option<String>,
    /// Unit of the number; `d` for the dates of spreadsheets.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) unit: Option<String>,
    /// Names of the columns with date and clock time, whose cells are joined by blanks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) columns: Vec<String>,
    /// Format of the joined cells in the notation of `strptime`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) format: Option<String>,
    /// Name of a column with the milliseconds of the second.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) milliseconds: Option<String>,
    /// Sampling rate, where the rows are equally spaced \[Hz\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) rate_hz: Option<f64>,
}

/// Checked statement of the time of each row.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Clock<'a> {
    /// Number in a column, and its factor to seconds.
    Elapsed(&'a str, f64),
    /// Date and clock time in columns, their format, and a column with milliseconds.
    Calendar(&'a [String], &'a str, Option<&'a str>),
    /// Equal steps \[s\].
    Steps(f64),
}

impl Time {
    /// Returns the statement as one of its three forms.
    ///
    /// # Errors
    /// Returns an error for keys of several forms, missing keys, and a unit that is none of time.
    pub(crate) fn clock(&self, document: &Document) -> Result<Clock<'_>, CaseError> {
        let fault = |key: &str, value: String, allowed: &str, help: &str| {
            document.field(
                &[DocumentStep::Key("time"), DocumentStep::Key(key)],
                value,
                allowed,
                help,
            )
        };
        let parts = (
            &self.column,
            &self.unit,
            &self.columns[..],
            &self.format,
            self.rate_hz,
        );
        match parts {
            (Some(column), Some(unit), [], None, None) if self.milliseconds.is_none() => {
                let factor = unit::factor(unit, "s").ok_or_else(|| {
                    fault(
                        "unit",
                        format!("\"{unit}\""),
                        "a unit of time",
                        "state s, ms, min, h, or d for the dates of spreadsheets",
                    )
                })?;
                Ok(Clock::Elapsed(column, factor))
            }
            (None, None, [_, ..], Some(format), None) => {
                Ok(Clock::Calendar(&self.columns, format, self.milliseconds.as_deref()))
            }
            (None, None, [], None, Some(rate)) if self.milliseconds.is_none() => {
                document.within("time.rate_hz", rate, 0.1..=1.0e7, "Hz")?;
                Ok(Clock::Steps(1.0 / rate))
            }
            _ => Err(document.field(
                &[DocumentStep::Key("time")],
                "{ .. }",
                "`column` and `unit`; or `columns` and `format`, and `milliseconds` if that is a column; or `rate_hz`",
                "state one of the three",
            )),
        }
    }
}

/// Formats of dates, by the order in which they are tried; `%d` before `%m` where both are possible.
const DATES: [&str; 8] = [
    "%Y-%m-%d", "%Y/%m/%d", "%d.%m.%Y", "%d/%m/%Y", "%m/%d/%Y", "%d-%m-%Y", "%d.%m.%y", "%m/%d/%y",
];

/// Formats of clock times.
const CLOCKS: [&str; 3] = ["%H:%M:%S%.f", "%I:%M:%S%.f %p", "%H:%M"];

/// Length of a day \[s\].
const DAY: f64 = 86_400.0;

/// Converts a date and clock time to seconds \[s\]: since 1970 in UTC if it has a date, else since midnight.
/// `None` if it is not of the format.
pub(super) fn seconds(format: &str, written: &str, layout: &Layout) -> Option<f64> {
    let point = if layout.decimal == ',' && !format.contains(',') {
        written.replace(',', ".")
    } else {
        written.to_owned()
    };
    let parsed = BrokenDownTime::parse(format, point.trim()).ok()?;
    let fraction = |nanoseconds: i32| f64::from(nanoseconds) * 1e-9;
    if parsed.offset().is_some() {
        let moment = parsed.to_timestamp().ok()?;
        return Some(moment.as_second() as f64 + fraction(moment.subsec_nanosecond()));
    }
    if parsed.year().is_some() {
        let moment = parsed.to_datetime().ok()?.to_zoned(TimeZone::UTC).ok()?;
        let moment = moment.timestamp();
        return Some(moment.as_second() as f64 + fraction(moment.subsec_nanosecond()));
    }
    let time = parsed.to_time().ok()?;
    let minutes = f64::from(time.hour()) * 60.0 + f64::from(time.minute());
    let seconds = 60.0 * minutes + f64::from(time.second());
    Some(seconds + fraction(time.subsec_nanosecond()))
}

/// Removes the passing of midnight from clock times without a date: a time that falls by more than half a day
/// belongs to the next day.
pub(super) fn over_midnight(times: &mut [f64]) {
    let mut days = 0.0;
    let mut before = f64::NEG_INFINITY;
    for time in times {
        if *time + days < before - 0.5 * DAY {
            days += DAY;
        }
        *time += days;
        before = *time;
    }
}

/// Words in the names of columns of time.
const NAMES: [&str; 12] = [
    "time",
    "zeit",
    "elapsed",
    "timestamp",
    "date",
    "datum",
    "uhrzeit",
    "clock",
    "sec",
    "seconds",
    "t",
    "abs",
];

/// Proposes which columns state the time, from names, units and cells of some rows; `None` where none does.
pub(crate) fn propose(columns: &Columns, rows: &[Vec<String>], layout: &Layout) -> Option<Time> {
    let cells = |place: usize| -> Vec<&str> {
        let cells = rows.iter().filter_map(|row| row.get(place));
        cells.map(String::as_str).collect()
    };
    let names = &columns.names;
    // a clock in one column, or a date in one column and a clock in the next one
    for place in 0..names.len() {
        if let Some(format) = format_of(&cells(place), layout) {
            return Some(clock(columns, &[place], format));
        }
        let joined: Vec<String> = rows
            .iter()
            .filter_map(|row| Some(format!("{} {}", row.get(place)?, row.get(place + 1)?)))
            .collect();
        let joined: Vec<&str> = joined.iter().map(String::as_str).collect();
        if let Some(format) = format_of(&joined, layout).filter(|_| place + 1 < names.len()) {
            return Some(clock(columns, &[place, place + 1], format));
        }
    }
    let named = |name: &str| {
        let lower = name.to_lowercase();
        let mut words = lower.split(|sign: char| !sign.is_alphabetic());
        words.any(|word| NAMES.contains(&word))
    };
    let of_time = |place: &usize| {
        let unit = columns.units.get(*place).and_then(Option::as_deref);
        unit.is_some_and(|unit| unit::factor(unit, "s").is_some())
    };
    let numbers = |place: &usize| {
        let mut cells = cells(*place).into_iter();
        cells.all(|cell| layout.number(cell.as_bytes()).is_some())
    };
    let mut numeric = (0..names.len()).filter(numbers);
    let place = numeric
        .clone()
        .find(|place| names.get(*place).is_some_and(|name| named(name)) && of_time(place))
        .or_else(|| numeric.clone().find(of_time))
        .or_else(|| {
            // a unit in brackets that is not known, such as microseconds, is left to the user
            let plain = |name: &String| named(name) && !name.contains(['[', '(']);
            numeric.find(|place| names.get(*place).is_some_and(plain))
        })?;
    let first = cells(place)
        .first()
        .and_then(|cell| layout.number(cell.as_bytes()));
    // spreadsheets count days from 1900: 36,526 is the year 2000
    let date = first.is_some_and(|first| (36_526.0..73_051.0).contains(&first));
    let unit = columns.units.get(place).cloned().flatten();
    let unit = unit.unwrap_or_else(|| if date { "d" } else { "s" }.to_owned());
    Some(Time {
        column: Some(names.get(place)?.clone()),
        unit: Some(unit),
        ..Time::default()
    })
}

fn clock(columns: &Columns, places: &[usize], format: String) -> Time {
    let after = places.last().map_or(0, |place| place + 1);
    let name = columns.names.get(after).map(|name| name.to_lowercase());
    let named = name.is_some_and(|name| name == "ms" || name.starts_with("millisec"));
    let is_ms = named || columns.units.get(after).and_then(Option::as_deref) == Some("ms");
    Time {
        columns: places
            .iter()
            .filter_map(|place| columns.names.get(*place).cloned())
            .collect(),
        format: Some(format),
        milliseconds: columns.names.get(after).filter(|_| is_ms).cloned(),
        ..Time::default()
    }
}

/// Returns the first format that all cells have; of several, the one with the shortest time from first to
/// last, which a day taken for a month would make longer.
fn format_of(cells: &[&str], layout: &Layout) -> Option<String> {
    if !cells.first()?.contains(':') {
        return None;
    }
    let dates = DATES.iter().flat_map(|date| {
        let zones = ["", "%:z", "%z", "Z", " %:z", " %z"];
        CLOCKS.iter().flat_map(move |clock| {
            ["T", " "]
                .into_iter()
                .flat_map(move |between| zones.map(|zone| format!("{date}{between}{clock}{zone}")))
        })
    });
    let bare = CLOCKS.iter().map(|clock| (*clock).to_owned());
    let span = |format: &String| -> Option<f64> {
        let first = seconds(format, cells.first()?, layout)?;
        let all = cells.iter().map(|cell| seconds(format, cell, layout));
        let all: Vec<f64> = all.collect::<Option<_>>()?;
        Some(all.last()? - first)
    };
    let possible = dates
        .chain(bare)
        .filter_map(|format| Some((span(&format)?, format)));
    let best = possible.min_by(|(a, _), (b, _)| a.abs().total_cmp(&b.abs()));
    best.map(|(_, format)| format)
}

#[cfg(test)]
mod tests {
    use super::super::layout::Delimiter;
    use super::*;

    fn layout(decimal: char) -> Layout {
        Layout {
            delimiter: Delimiter::Semicolon,
            decimal,
            thousands: None,
            header_line: None,
            units_line: None,
            first_line: 1,
            footer_lines: 0,
            missing: Vec::new(),
        }
    }

    /// Checks that day and month, zones, fractions and halves of the day are told apart.
    #[test]
    fn times_are_read_as_they_are_written() {
        let cases: [(&[&str], &str, f64); 7] = [
            (
                &["2024-05-01T12:00:00.250+02:00", "2024-05-01T10:00:01.000Z"],
                "",
                0.0,
            ),
            (
                &[
                    "2024-05-01T12:00:00.250+02:00",
                    "2024-05-01T12:00:00.500+02:00",
                ],
                "%Y-%m-%dT%H:%M:%S%.f%:z",
                0.25,
            ),
            (
                &["30.04.2024 23:59:59,5", "01.05.2024 00:00:00,5"],
                "%d.%m.%Y %H:%M:%S%.f",
                1.0,
            ),
            (
                &["04/30/2024 11:59:59 PM", "05/01/2024 12:00:00 AM"],
                "%m/%d/%Y %I:%M:%S%.f %p",
                1.0,
            ),
            (
                &["02/03/2024 23:59:59", "03/03/2024 00:00:00"],
                "%d/%m/%Y %H:%M:%S%.f",
                1.0,
            ),
            (
                &["02/03/2024 23:59:59", "02/04/2024 00:00:00"],
                "%m/%d/%Y %H:%M:%S%.f",
                1.0,
            ),
            (&["12:00:00.5", "12:00:01"], "%H:%M:%S%.f", 0.5),
        ];
        for (cells, expected, span) in cases {
            let layout = layout(if cells[0].contains(',') { ',' } else { '.' });
            let format = format_of(cells, &layout);
            assert_eq!(format.as_deref().unwrap_or_default(), expected, "{cells:?}");
            if let Some(format) = format {
                let [first, last] =
                    [cells[0], cells[1]].map(|cell| seconds(&format, cell, &layout).unwrap());
                assert!(
                    (last - first - span).abs() < 1e-6,
                    "{cells:?}: {first} {last}"
                );
            }
        }
    }

    #[test]
    fn clocks_without_a_date_pass_midnight() {
        let mut times = [86_399.0, 0.0, 1.0, 0.5];
        over_midnight(&mut times);
        assert_eq!(
            times.map(f64::to_bits),
            [86_399.0_f64, 86_400.0, 86_401.0, 86_400.5].map(f64::to_bits)
        );
    }
}
