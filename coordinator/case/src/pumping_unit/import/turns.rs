//! Crank angles of the samples of a raw file, and the whole turns among them.
use super::{
    logger::{self, Table},
    mapping::{Angle, Direction, Edge},
};
use crate::error::{CaseError, damaged};

/// Samples in succession whose crank angle is known.
#[derive(Debug, Default)]
pub(super) struct Stretch {
    /// Row of each sample in its table.
    pub(super) rows: Vec<usize>,
    /// Crank angle from bottom dead centre \[deg\], counted on over the turns; never decreasing.
    pub(super) angle_deg: Vec<f64>,
    /// Angles at which the first whole turn begins and the last one ends \[deg\].
    pub(super) whole_deg: [f64; 2],
}

/// Whole turns of one file, as ranges of rows, and what was left out.
#[derive(Debug, Default)]
pub(super) struct Turns {
    /// Stretches of whole turns.
    pub(super) stretches: Vec<Stretch>,
    /// Durations of the whole turns \[s\].
    pub(super) durations_s: Vec<f64>,
    /// What was left out and why.
    pub(super) left_out: Vec<String>,
}

/// Largest deviation of a turn's duration from the median; a turn beyond it has a lost pulse, a gap or a jump
/// of the clock in it. Belt slip and a ripple of the speed change it by a few percent.
const DEVIATION: f64 = 0.1;

/// Largest backward step of an angle column \[deg\] that counts as noise of the encoder.
const JITTER: f64 = 2.0;

/// Angle by which samples before the first pulse and after the last one are kept \[deg\], so that the turns
/// between them are resampled from both sides.
const MARGIN: f64 = 5.0;

/// Finds the whole turns of a file. The angle or pulse is the first column of the table; `expected_s` is the
/// duration of a turn by the case.
///
/// # Errors
/// Returns an error for no pulse, several pulses a turn, and an angle column that runs backwards. Without a
/// whole turn there are no stretches.
pub(super) fn turns(table: &Table, angle: &Angle, expected_s: f64) -> Result<Turns, CaseError> {
    let stretches = match angle {
        Angle::Column {
            column,
            unit,
            bottom_dead_centre_deg,
            direction,
        } => {
            let factor = logger::factor(unit, "deg").ok_or_else(|| {
                damaged(
                    table.place(0).0,
                    format!("`angle.unit` = \"{unit}\" is not a unit of angle"),
                    "state deg, rad or rev in the mapping",
                )
            })?;
            let sign = match direction {
                Direction::Increasing => 1.0,
                Direction::Decreasing => -1.0,
            };
            let angle = |value: f64| sign * (value * factor - bottom_dead_centre_deg);
            unwrapped(table, column, angle, expected_s)?
        }
        Angle::Pulse { pulse_deg, .. } => {
            let pulses = pulses(table, angle, expected_s)?;
            between(table, &pulses, *pulse_deg)
        }
    };
    let mut turns = Turns::default();
    let crossings = stretches
        .iter()
        .map(|stretch| crossings(table, stretch))
        .collect::<Vec<_>>();
    let mut durations: Vec<f64> = crossings
        .iter()
        .flatten()
        .map(|turn| turn.length_s)
        .collect();
    durations.sort_by(f64::total_cmp);
    let Some(&median) = durations.get(durations.len() / 2) else {
        return Ok(turns);
    };
    for (stretch, crossings) in stretches.iter().zip(&crossings) {
        cut(table, stretch, crossings, median, &mut turns);
    }
    Ok(turns)
}

/// Whole turn within a stretch.
struct Turn {
    /// Number of the turn: its angles begin at 360 times it.
    number: f64,
    length_s: f64,
}

/// Returns the whole turns of a stretch with their durations.
fn crossings(table: &Table, stretch: &Stretch) -> Vec<Turn> {
    let mut crossings: Vec<(f64, f64)> = Vec::new();
    let pairs = stretch.rows.windows(2).zip(stretch.angle_deg.windows(2));
    for (rows, angles) in pairs {
        let (&[before, after], &[low, high]) = (rows, angles) else {
            continue;
        };
        let turn = (high / 360.0).floor();
        if (low / 360.0).floor() < turn {
            let (from, to) = (table.time_s[before], table.time_s[after]);
            let share = (360.0 * turn - low) / (high - low);
            crossings.push((turn, from + share * (to - from)));
        }
    }
    // a stretch that begins at bottom dead centre
    if let (Some(&row), Some(&angle)) = (stretch.rows.first(), stretch.angle_deg.first())
        && (angle / 360.0 - (angle / 360.0).round()).abs() < 1e-9
    {
        crossings.insert(0, ((angle / 360.0).round(), table.time_s[row]));
    }
    let pairs = crossings.windows(2);
    let turn = |pair: &[(f64, f64)]| match pair {
        &[(number, from), (next, to)] if (next - number - 1.0).abs() < 0.5 => Some(Turn {
            number,
            length_s: to - from,
        }),
        _ => None,
    };
    pairs.filter_map(turn).collect()
}

/// Cuts a stretch into runs of whole turns of the usual duration.
fn cut(table: &Table, stretch: &Stretch, whole: &[Turn], median: f64, turns: &mut Turns) {
    let mut runs: Vec<(f64, f64)> = Vec::new();
    for turn in whole {
        if (turn.length_s / median - 1.0).abs() > DEVIATION {
            let at = stretch
                .angle_deg
                .partition_point(|angle| *angle < 360.0 * turn.number);
            let row = stretch.rows.get(at).copied().unwrap_or_default();
            turns.left_out.push(format!(
                "the turn from line {} on took {:.2} s, others {median:.2} s",
                table.place(row).1,
                turn.length_s
            ));
            continue;
        }
        turns.durations_s.push(turn.length_s);
        match runs.last_mut() {
            Some((_, end)) if (*end - turn.number).abs() < 0.5 => *end = turn.number + 1.0,
            _ => runs.push((turn.number, turn.number + 1.0)),
        }
    }
    let ends = stretch.angle_deg.first().zip(stretch.angle_deg.last());
    for (first, end) in runs {
        // what is left of the turns before and after: a turn that lacks little is still of use
        let beyond = |turn: f64| !whole.iter().any(|own| (own.number - turn).abs() < 0.5);
        let whole_deg = [360.0 * first, 360.0 * end];
        let [mut from, mut to] = whole_deg;
        if let Some((lowest, highest)) = ends {
            if beyond(first - 1.0) {
                from = lowest.max(from - 360.0);
            }
            if beyond(end) {
                to = highest.min(to + 360.0) + 1e-9;
            }
        }
        let from = stretch.angle_deg.partition_point(|angle| *angle < from);
        let to = stretch.angle_deg.partition_point(|angle| *angle < to);
        turns.stretches.push(Stretch {
            rows: stretch.rows[from..to].to_vec(),
            angle_deg: stretch.angle_deg[from..to].to_vec(),
            whole_deg,
        });
    }
}

/// Unwraps an angle column into stretches without gaps of almost half a turn.
fn unwrapped(
    table: &Table,
    column: &str,
    angle: impl Fn(f64) -> f64,
    expected_s: f64,
) -> Result<Vec<Stretch>, CaseError> {
    let mut all: Vec<Stretch> = Vec::new();
    let mut before: Option<(f64, f64)> = None;
    let mut unwrapped = 0.0_f64;
    let mut highest = f64::NEG_INFINITY;
    for (row, (&value, &time)) in table.columns[0].iter().zip(&table.time_s).enumerate() {
        if value.is_nan() {
            continue;
        }
        let now = angle(value);
        let gap = before.is_none_or(|(_, at)| time - at > 0.4 * expected_s);
        match before {
            Some((last, _)) if !gap => {
                unwrapped += (now - last + 180.0).rem_euclid(360.0) - 180.0;
            }
            _ => {
                unwrapped = now.rem_euclid(360.0);
                highest = f64::NEG_INFINITY;
                all.push(Stretch::default());
            }
        }
        before = Some((now, time));
        if unwrapped < highest - JITTER {
            return Err(table.fault(
                row,
                column,
                format!("{value}, {:.1} deg before the rows above,", highest - unwrapped),
                "an angle that increases with time, by `angle.direction` of the mapping",
                "correct `angle.direction` in the mapping if it falls everywhere; else the crank was turned back \
                 or the encoder failed: cut the rows from a copy",
            ));
        }
        highest = highest.max(unwrapped);
        if let Some(stretch) = all.last_mut() {
            stretch.rows.push(row);
            stretch.angle_deg.push(highest);
        }
    }
    Ok(all)
}

/// Returns the times of the pulses, in lists without long gaps between them.
fn pulses(table: &Table, angle: &Angle, expected_s: f64) -> Result<Vec<f64>, CaseError> {
    let Angle::Pulse {
        column,
        level,
        edge,
        ..
    } = angle
    else {
        return Ok(Vec::new());
    };
    let values = &table.columns[0];
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let known = || (0..values.len()).filter(|row| !values[*row].is_nan());
    let mut times: Vec<f64> = Vec::new();
    let mut rows: Vec<usize> = Vec::new();
    for (before, after) in known().zip(known().skip(1)) {
        let (low, high) = match edge {
            Edge::Rising => (values[before], values[after]),
            Edge::Falling => (-values[before], -values[after]),
        };
        let level = match edge {
            Edge::Rising => *level,
            Edge::Falling => -level,
        };
        if !(low < level && level <= high) {
            continue;
        }
        let share = (level - low) / (high - low);
        let (from, to) = (table.time_s[before], table.time_s[after]);
        let at = from + share * (to - from);
        // a contact that bounces closes again within milliseconds
        if times
            .last()
            .is_none_or(|last| at - last > 0.05 * expected_s)
        {
            times.push(at);
            rows.push(after);
        }
    }
    let fault = |value: String, allowed: &str, help: &str| {
        let row = rows.first().copied().unwrap_or_default();
        table.fault(row, column, value, allowed, help)
    };
    if times.len() < 2 {
        return Err(fault(
            format!(
                "a signal from {lowest} to {highest} with {} pulses at the level {level}",
                times.len()
            ),
            "two pulses at least, one a turn",
            "correct `angle.level` and `angle.edge` in the mapping, or check the sensor; without pulses the \
             crank angle is not known",
        ));
    }
    let mut intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    intervals.sort_by(f64::total_cmp);
    let median = intervals[intervals.len() / 2];
    let per_turn = expected_s / median;
    if per_turn > 1.5 && (per_turn / per_turn.round() - 1.0).abs() < DEVIATION {
        return Err(fault(
            format!(
                "a pulse every {median:.2} s, {per_turn:.0} a turn of {expected_s:.2} s by the case,"
            ),
            "one pulse a turn",
            "leave one magnet on the crank, or raise `angle.level` if the pulses differ in height; which of \
             several pulses is which cannot be known",
        ));
    }
    Ok(times)
}

/// Returns the angles of the samples, which are uniform in time between pulses.
fn between(table: &Table, pulses: &[f64], pulse_deg: f64) -> Vec<Stretch> {
    let mut intervals: Vec<f64> = pulses.windows(2).map(|pair| pair[1] - pair[0]).collect();
    intervals.sort_by(f64::total_cmp);
    let median = intervals
        .get(intervals.len() / 2)
        .copied()
        .unwrap_or_default();
    let mut all: Vec<Stretch> = vec![Stretch::default()];
    let margin = MARGIN / 360.0 * median;
    for (row, &time) in table.time_s.iter().enumerate() {
        let after = pulses.partition_point(|pulse| *pulse <= time);
        let angle = |from: f64, turn: usize, length: f64| {
            pulse_deg.rem_euclid(360.0) + 360.0 * (turn as f64 + (time - from) / length)
        };
        let last = pulses.len() - 1;
        let angle = match after {
            0 if time > pulses[0] - margin => angle(pulses[0], 0, pulses[1] - pulses[0]),
            0 => continue,
            _ if after > last => {
                let length = pulses[last] - pulses[last - 1];
                if time > pulses[last] + margin {
                    continue;
                }
                angle(pulses[last], last, length)
            }
            _ => angle(
                pulses[after - 1],
                after - 1,
                pulses[after] - pulses[after - 1],
            ),
        };
        if let Some(stretch) = all.last_mut() {
            stretch.rows.push(row);
            stretch.angle_deg.push(angle);
        }
    }
    all
}
