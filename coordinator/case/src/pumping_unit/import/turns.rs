//! Crank angles of the samples of raw files, and the whole turns among them.
use super::{
    logger::{self, Table},
    mapping::{Angle, Direction, Edge},
};
use crate::error::{CaseError, damaged};

/// Samples in succession whose crank angle is known.
#[derive(Debug, Default)]
pub(super) struct Segment {
    /// Row of each sample in its table.
    pub(super) rows: Vec<usize>,
    /// Crank angle from bottom dead centre \[deg\], counted on over the turns; never decreasing.
    pub(super) angle_deg: Vec<f64>,
    /// Angles at which the first whole turn begins and the last one ends \[deg\].
    pub(super) whole_deg: [f64; 2],
}

/// Whole turns of a table, and what was left out.
#[derive(Debug, Default)]
pub(super) struct Turns {
    /// Segments of whole turns, with what is of use of the turns before and after.
    pub(super) segments: Vec<Segment>,
    /// Durations of the whole turns \[s\].
    pub(super) durations_s: Vec<f64>,
    /// What was left out and why.
    pub(super) left_out: Vec<String>,
}

/// Largest deviation of a turn's duration from the median; a turn beyond it has a lost pulse, a standstill or
/// a jump of the clock in it. Belt slip and a ripple of the speed change it by a few percent.
const DEVIATION: f64 = 0.1;

/// Largest backward step of an angle column \[deg\] that counts as noise of the encoder.
const JITTER: f64 = 2.0;

/// Angle by which samples before the first pulse and after the last one are kept \[deg\], so that the turns
/// between them are resampled from both sides.
const MARGIN: f64 = 2.0;

/// Longest time without samples within a turn, as a share of its duration: beyond half a turn an angle column
/// does not tell the number of turns.
const GAP: f64 = 0.4;

/// Longest time between two samples across which the time of a pulse is interpolated, in median steps.
const STEPS: f64 = 3.0;

/// Finds the whole turns of a table. The angle or pulse is the first column; `valid` are the rows with a value
/// of every curve, `expected_s` is the duration of a turn by the case.
///
/// # Errors
/// Returns an error for no pulse, several pulses a turn, and an angle column that runs backwards. Without a
/// whole turn there are no segments.
pub(super) fn turns(
    table: &Table,
    valid: &[usize],
    angle: &Angle,
    expected_s: f64,
) -> Result<Turns, CaseError> {
    let mut turns = Turns::default();
    let segments = match angle {
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
            unwrapped(table, valid, (column, angle), expected_s)?
        }
        Angle::Pulse {
            column,
            level,
            edge,
            pulse_deg,
        } => {
            let pulses = pulses(table, (column, *level, *edge), expected_s)?;
            let regular = regular(table, &pulses, &mut turns.left_out);
            let of = |run: &[f64]| between(table, valid, run, *pulse_deg, expected_s);
            regular.iter().flat_map(|run| of(run)).collect()
        }
    };
    for pair in segments.windows(2) {
        if let [before, after] = pair
            && let (Some(&last), Some(&first)) = (before.rows.last(), after.rows.first())
            && table.time_s[first] - table.time_s[last] > GAP * expected_s
        {
            let (path, line) = table.place(first);
            let path = path.file_name().unwrap_or_default().display();
            turns
                .left_out
                .push(format!("the turn before line {line} of {path}: a gap"));
        }
    }
    let whole: Vec<Vec<Turn>> = segments
        .iter()
        .map(|segment| crossings(table, segment))
        .collect();
    let Some(median) = median(whole.iter().flatten().map(|turn| turn.length_s)) else {
        return Ok(turns);
    };
    for (segment, whole) in segments.iter().zip(&whole) {
        cut(table, segment, whole, median, &mut turns);
    }
    Ok(turns)
}

/// Returns the median, of an even number of values the lower one: a doubled turn beside a single regular one
/// is not the rule.
fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len().saturating_sub(1) / 2).copied()
}

/// Whole turn within a segment.
struct Turn {
    /// Number of the turn: its angles begin at 360 times it.
    number: f64,
    start_s: f64,
    length_s: f64,
}

/// Returns the whole turns of a segment with their durations.
fn crossings(table: &Table, segment: &Segment) -> Vec<Turn> {
    let mut crossings: Vec<(f64, f64)> = Vec::new();
    let pairs = segment.rows.windows(2).zip(segment.angle_deg.windows(2));
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
    // a segment that begins at bottom dead centre
    if let (Some(&row), Some(&angle)) = (segment.rows.first(), segment.angle_deg.first())
        && (angle / 360.0 - (angle / 360.0).round()).abs() < 1e-9
    {
        crossings.insert(0, ((angle / 360.0).round(), table.time_s[row]));
    }
    let turn = |pair: &[(f64, f64)]| match pair {
        &[(number, from), (next, to)] if (next - number - 1.0).abs() < 0.5 => Some(Turn {
            number,
            start_s: from,
            length_s: to - from,
        }),
        _ => None,
    };
    crossings.windows(2).filter_map(turn).collect()
}

/// Returns whether a duration is that of the other turns.
fn is_usual(length_s: f64, median: f64) -> bool {
    (length_s / median - 1.0).abs() <= DEVIATION
}

/// Returns the note about a turn of unusual duration.
fn unusual(table: &Table, row: usize, length_s: f64, median: f64) -> String {
    let (path, line) = table.place(row);
    let path = path.file_name().unwrap_or_default().display();
    format!("the turn from line {line} of {path} on: it took {length_s:.2} s, others {median:.2} s")
}

/// Cuts a segment into runs of whole turns of the usual duration.
fn cut(table: &Table, segment: &Segment, whole: &[Turn], median: f64, turns: &mut Turns) {
    let mut runs: Vec<(&Turn, &Turn)> = Vec::new();
    for turn in whole {
        if !is_usual(turn.length_s, median) {
            let at = segment
                .angle_deg
                .partition_point(|angle| *angle < 360.0 * turn.number);
            let row = segment.rows.get(at).copied().unwrap_or_default();
            turns
                .left_out
                .push(unusual(table, row, turn.length_s, median));
            continue;
        }
        turns.durations_s.push(turn.length_s);
        match runs.last_mut() {
            Some((_, last)) if (turn.number - last.number - 1.0).abs() < 0.5 => *last = turn,
            _ => runs.push((turn, turn)),
        }
    }
    let time = |at: Option<&usize>| at.map_or(0.0, |row| table.time_s[*row]);
    let (lowest, highest) = (
        segment.angle_deg.first().copied().unwrap_or_default(),
        segment.angle_deg.last().copied().unwrap_or_default(),
    );
    for (first, last) in runs {
        let whole_deg = [360.0 * first.number, 360.0 * (last.number + 1.0)];
        let [mut from, mut to] = whole_deg;
        // what is left of the turns before and after is of use where the crank ran at the same speed
        let before = first.start_s - time(segment.rows.first());
        if is_usual(before, (from - lowest) / 360.0 * median) {
            from = lowest;
        }
        let after = time(segment.rows.last()) - (last.start_s + last.length_s);
        if is_usual(after, (highest - to) / 360.0 * median) {
            to = highest + 1e-9;
        }
        let from = segment.angle_deg.partition_point(|angle| *angle < from);
        let to = segment.angle_deg.partition_point(|angle| *angle < to);
        turns.segments.push(Segment {
            rows: segment.rows[from..to].to_vec(),
            angle_deg: segment.angle_deg[from..to].to_vec(),
            whole_deg,
        });
    }
}

/// Unwraps an angle column into segments without gaps of almost half a turn. The noise of the encoder becomes
/// a monotone angle half way between the running maximum and the running minimum of what follows.
fn unwrapped(
    table: &Table,
    valid: &[usize],
    (column, angle): (&str, impl Fn(f64) -> f64),
    expected_s: f64,
) -> Result<Vec<Segment>, CaseError> {
    let mut all: Vec<Segment> = Vec::new();
    let mut before: Option<(f64, f64)> = None;
    let (mut raw, mut highest) = (0.0_f64, f64::NEG_INFINITY);
    for &row in valid {
        let (value, time) = (table.columns[0][row], table.time_s[row]);
        if value.is_nan() {
            continue;
        }
        let now = angle(value);
        match before {
            Some((last, at)) if time - at <= GAP * expected_s => {
                raw += (now - last + 180.0).rem_euclid(360.0) - 180.0;
            }
            _ => {
                raw = now.rem_euclid(360.0);
                highest = f64::NEG_INFINITY;
                all.push(Segment::default());
            }
        }
        before = Some((now, time));
        highest = highest.max(raw);
        if raw < highest - JITTER {
            return Err(table.fault(
                row,
                column,
                format!("{value}, {:.1} deg before the rows above,", highest - raw),
                "an angle that increases with time, by `angle.direction` of the mapping",
                "correct `angle.direction` in the mapping if it falls everywhere; else the crank was turned back \
                 or the encoder failed: cut the rows from a copy",
            ));
        }
        if let Some(segment) = all.last_mut() {
            segment.rows.push(row);
            segment.angle_deg.push(raw);
        }
    }
    for segment in &mut all {
        let repeats = segment
            .angle_deg
            .windows(2)
            .filter(|pair| pair[0].total_cmp(&pair[1]).is_eq());
        let in_steps = repeats.count() as f64 > REPEATED * segment.angle_deg.len() as f64;
        let mut lowest = f64::INFINITY;
        let below = segment.angle_deg.iter().rev().map(|angle| {
            lowest = lowest.min(*angle);
            lowest
        });
        let below: Vec<f64> = below.collect();
        let mut highest = f64::NEG_INFINITY;
        for (angle, below) in segment.angle_deg.iter_mut().zip(below.iter().rev()) {
            highest = highest.max(*angle);
            *angle = 0.5 * (highest + below);
        }
        if in_steps {
            interpolate_steps(table, segment);
        }
    }
    Ok(all)
}

/// Share of samples that repeat the angle before, from which on the angle is that of an encoder of coarse
/// steps or was held between its readings.
const REPEATED: f64 = 0.2;

/// Longest time that an angle is held, relative to the median, with which the crank counts as turning.
const HELD: f64 = 3.0;

/// Replaces an angle in steps by the line between its changes. An angle that is held for the same number of
/// samples each time was read at its changes; one of an encoder of coarse steps passed them half a sample
/// before.
fn interpolate_steps(table: &Table, segment: &mut Segment) {
    let angles = &segment.angle_deg;
    let changes: Vec<usize> = (1..angles.len())
        .filter(|at| angles[*at] > angles[*at - 1])
        .collect();
    if changes.len() < 3 {
        return;
    }
    let time = |at: usize| table.time_s[segment.rows[at]];
    let lengths = || changes.windows(2).map(|pair| (pair[1] - pair[0]) as f64);
    let Some(usual) = median(lengths()) else {
        return;
    };
    let alike = lengths()
        .filter(|length| (length - usual).abs() < 0.5)
        .count();
    let held = alike as f64 > 0.9 * lengths().count() as f64;
    let knot = |at: usize| {
        if held {
            time(at)
        } else {
            0.5 * (time(at) + time(at - 1))
        }
    };
    let held_s = median(changes.windows(2).map(|pair| time(pair[1]) - time(pair[0])));
    let longest = HELD * held_s.unwrap_or_default();
    let smooth = (0..angles.len()).map(|at| {
        let after = changes.partition_point(|own| *own <= at);
        // before the first change and after the last one the rate is that of the neighbours
        let to = after.clamp(1, changes.len() - 1);
        let (from, to) = (changes[to - 1], changes[to]);
        let since = time(at) - knot(from);
        let width = knot(to) - knot(from);
        if width > longest || since.abs() > 2.0 * longest {
            return angles[at];
        }
        angles[from] + (angles[to] - angles[from]) * since / width
    });
    let smooth: Vec<f64> = smooth.collect();
    let mut highest = f64::NEG_INFINITY;
    let rising = smooth.into_iter().map(|angle| {
        highest = highest.max(angle);
        highest
    });
    segment.angle_deg = rising.collect();
}

/// Time of a pulse, and the row after its edge.
#[derive(Clone, Copy, Debug)]
struct Pulse {
    time_s: f64,
    row: usize,
}

/// Returns the pulses of a column, given with level and edge, whose times are known.
fn pulses(
    table: &Table,
    (column, level, edge): (&str, f64, Edge),
    expected_s: f64,
) -> Result<Vec<Pulse>, CaseError> {
    let sign = match edge {
        Edge::Rising => 1.0,
        Edge::Falling => -1.0,
    };
    let values = &table.columns[0];
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let step = median(table.time_s.windows(2).map(|pair| pair[1] - pair[0])).unwrap_or_default();
    let known = || (0..values.len()).filter(|row| !values[*row].is_nan());
    let mut pulses: Vec<Pulse> = Vec::new();
    for (before, after) in known().zip(known().skip(1)) {
        let (low, high) = (
            sign * (values[before] - level),
            sign * (values[after] - level),
        );
        let (from, to) = (table.time_s[before], table.time_s[after]);
        if !(low < 0.0 && 0.0 <= high) || to - from > STEPS * step {
            continue;
        }
        let time_s = from + low / (low - high) * (to - from);
        // a contact that bounces closes again within milliseconds
        if pulses
            .last()
            .is_none_or(|last| time_s - last.time_s > 0.05 * expected_s)
        {
            pulses.push(Pulse { time_s, row: after });
        }
    }
    let fault = |value: String, allowed: &str, help: &str| {
        let row = pulses.first().map_or(0, |pulse| pulse.row);
        table.fault(row, column, value, allowed, help)
    };
    let intervals = pulses
        .windows(2)
        .map(|pair| pair[1].time_s - pair[0].time_s);
    let Some(interval) = median(intervals) else {
        return Err(fault(
            format!(
                "a signal from {lowest} to {highest} with {} pulses at the level {level}",
                pulses.len()
            ),
            "two pulses at least, one a turn",
            "correct `angle.level` and `angle.edge` in the mapping, or check the sensor; without pulses the \
             crank angle is not known",
        ));
    };
    let span = pulses.last().map_or(0.0, |last| last.time_s) - pulses[0].time_s;
    let per_turn = (pulses.len() - 1) as f64 * expected_s / span;
    let of_one = expected_s / interval;
    if per_turn > 1.5 || (of_one > 1.5 && is_usual(of_one, of_one.round())) {
        return Err(fault(
            format!(
                "a pulse every {interval:.2} s, {:.0} a turn of {expected_s:.2} s by the case,",
                per_turn.max(of_one)
            ),
            "one pulse a turn",
            "leave one magnet on the crank, or raise `angle.level` if the pulses differ in height; which of \
             several pulses is which cannot be known",
        ));
    }
    Ok(pulses)
}

/// Returns the times of the pulses in runs whose intervals are all usual; notes those that are not.
fn regular(table: &Table, pulses: &[Pulse], left_out: &mut Vec<String>) -> Vec<Vec<f64>> {
    let intervals = pulses
        .windows(2)
        .map(|pair| pair[1].time_s - pair[0].time_s);
    let median = median(intervals).unwrap_or_default();
    let mut runs: Vec<Vec<f64>> = vec![Vec::new()];
    let mut before: Option<&Pulse> = None;
    for pulse in pulses {
        if let Some(last) = before
            && !is_usual(pulse.time_s - last.time_s, median)
        {
            left_out.push(unusual(table, last.row, pulse.time_s - last.time_s, median));
            runs.push(Vec::new());
        }
        before = Some(pulse);
        if let Some(run) = runs.last_mut() {
            run.push(pulse.time_s);
        }
    }
    runs.retain(|run| run.len() > 1);
    runs
}

/// Returns the angles of the samples between the pulses of a run, between which the crank turns uniformly.
fn between(
    table: &Table,
    valid: &[usize],
    run: &[f64],
    pulse_deg: f64,
    expected_s: f64,
) -> Vec<Segment> {
    let last = run.len() - 1;
    let margin = MARGIN / 360.0 * (run[last] - run[0]) / last as f64;
    let from = valid.partition_point(|row| table.time_s[*row] <= run[0] - margin);
    let to = valid.partition_point(|row| table.time_s[*row] <= run[last] + margin);
    let mut all: Vec<Segment> = Vec::new();
    let mut before = f64::NEG_INFINITY;
    for &row in &valid[from..to] {
        let time = table.time_s[row];
        let turn = run.partition_point(|pulse| *pulse <= time).clamp(1, last) - 1;
        let share = (time - run[turn]) / (run[turn + 1] - run[turn]);
        if time - before > GAP * expected_s {
            all.push(Segment::default());
        }
        before = time;
        if let Some(segment) = all.last_mut() {
            segment.rows.push(row);
            segment
                .angle_deg
                .push(pulse_deg.rem_euclid(360.0) + 360.0 * (turn as f64 + share));
        }
    }
    all
}
