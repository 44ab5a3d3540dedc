//! Load card from a dynamometer's file: load over position becomes load over crank angle.
use super::{
    cleaning, logger,
    mapping::{CardMapping, Order},
    paths::beside,
};
use crate::{
    document::{Document, DocumentStep},
    error::{CaseError, contradiction, damaged},
    pumping_unit::record::SPEED_TOLERANCE,
};
use std::{fmt::Write as _, path::Path};

/// Points of a dynamometer's card in the order of time, with what its file states beside them.
#[derive(Clone, Debug, PartialEq)]
struct Points {
    /// Number of rows that lack a cell and were left out.
    short: usize,
    position_m: Vec<f64>,
    load_n: Vec<f64>,
    strokes_per_minute: Option<f64>,
}

/// Load card over the crank angle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImportedCard {
    /// Text of the card: a table in CSV.
    pub csv: String,
    /// Crank angles of the points of the raw card from bottom dead centre, ascending \[deg\].
    pub turn_deg: Vec<f64>,
    /// Load of the points \[N\].
    pub load_n: Vec<f64>,
    /// Position of the points above the lowest one, as recorded \[m\].
    pub position_m: Vec<f64>,
    /// Position by the kinematics of the case at the same angles \[m\].
    pub expected_m: Vec<f64>,
    /// Remarks for the user.
    pub notes: Vec<String>,
}

/// Facts about the case that a card must fit.
#[derive(Clone, Debug)]
pub(super) struct Machine {
    pub(super) speed_rpm: f64,
    /// Position of the polished rod above its lowest one at equally spaced crank angles from bottom dead
    /// centre \[m\].
    pub(super) position_m: Vec<f64>,
}

/// Deviation between the strokes of card and case beyond which the card cannot be of the machine. The
/// position of a dynamometer that integrates its acceleration is within a few percent.
const STROKE_REFUSED: f64 = 0.2;

/// Deviation between the strokes of card and case that is worth a remark.
const STROKE_NOTED: f64 = 0.02;

/// Largest root mean square difference between the positions of a card and those of a crank at constant
/// speed, as a share of the stroke, with which the points count as equally spaced in time.
const EQUAL_TIMES: f64 = 0.01;

/// Largest gap between the ends of a card, as a share of the stroke, beyond three of its largest steps.
const OPEN: f64 = 0.02;

/// Share of the stroke beside either dead centre in which the position does not tell the crank angle.
const DEAD: f64 = 0.02;

/// Imports the card of a mapping.
///
/// # Errors
/// Returns an error for a malformed file, contradicting units, a stroke or speed that is not the case's, and
/// a card whose loads are lower on the upstroke.
pub(super) fn import(document: &Document, machine: &Machine) -> Result<ImportedCard, CaseError> {
    let mapping: CardMapping = document.parse()?;
    let [file] = mapping.files.as_slice() else {
        return Err(document.field(
            &[DocumentStep::Key("files")],
            mapping.files.len(),
            "one file",
            "a card is one file: choose one",
        ));
    };
    let path = beside(&document.path, file);
    let mut points = match &mapping.table {
        None if mapping.card.position.is_some() || mapping.card.load.is_some() => {
            return Err(document.field(
                &[DocumentStep::Key("card")],
                "{ .. }",
                "`position` and `load` only with `[table]`",
                "state the table's layout; or remove both for a file of Theta's format",
            ));
        }
        None => theta(&path)?,
        Some(_) => table(document, &path, &mapping)?,
    };
    if let Some(stated) = mapping.card.strokes_per_minute {
        points.strokes_per_minute = Some(stated);
    }
    if mapping.card.order == Order::Reversed {
        points.position_m.reverse();
        points.load_n.reverse();
    }
    if let Some(stated) = points.strokes_per_minute
        && (stated / machine.speed_rpm - 1.0).abs() > SPEED_TOLERANCE
    {
        return Err(contradiction(
            &path,
            "the speed of the card",
            format!("{stated} strokes per minute"),
            format!("the condition has speed_rpm = {}", machine.speed_rpm),
            "take the card of this condition; or, if the file states another speed by mistake, state \
             `card.strokes_per_minute` in the mapping",
        ));
    }
    over_angle(&path, points, machine)
}

/// Converts the points to crank angles and resamples the load.
fn over_angle(path: &Path, points: Points, machine: &Machine) -> Result<ImportedCard, CaseError> {
    let Points {
        short,
        mut position_m,
        mut load_n,
        ..
    } = points;
    let mut card = ImportedCard::default();
    if short > 0 {
        card.notes
            .push(format!("{short} rows that lack a cell are left out"));
    }
    // some programs close the loop by repeating the first point
    if let (Some(first), Some(last)) = (position_m.first(), position_m.last())
        && first.total_cmp(last).is_eq()
        && load_n.first() == load_n.last()
    {
        position_m.pop();
        load_n.pop();
    }
    let outliers = cleaning::remove_outliers(&mut load_n);
    if outliers > 0 {
        card.notes
            .push(format!("{outliers} outliers of the load are left out"));
        let known = position_m
            .iter()
            .zip(&load_n)
            .filter(|(_, load)| !load.is_nan());
        (position_m, load_n) = known.map(|(position, load)| (*position, *load)).unzip();
    }
    let count = position_m.len();
    if count < 24 {
        return Err(damaged(
            path,
            format!("the card has {count} points; allowed: at least 24 different ones"),
            "export the card with more points, or copy it again",
        ));
    }
    let lowest = position_m.iter().copied().fold(f64::INFINITY, f64::min);
    for position in &mut position_m {
        *position -= lowest;
    }
    let stroke = position_m.iter().copied().fold(0.0, f64::max);
    let expected = machine.position_m.iter().copied().fold(0.0, f64::max);
    check_stroke(path, stroke, expected, &mut card.notes)?;
    check_loop(path, &position_m, stroke)?;
    let scale = expected / stroke;
    let bottom = argmin(&position_m);
    position_m.rotate_left(bottom);
    load_n.rotate_left(bottom);
    let scaled: Vec<f64> = position_m.iter().map(|position| position * scale).collect();
    check_order(path, &scaled, expected, &load_n)?;
    let (shift, error) = constant_speed(&scaled, &machine.position_m);
    let angles: Vec<f64> = if error < EQUAL_TIMES * expected {
        let step = 360.0 / count as f64;
        (0..count).map(|at| at as f64 * step + shift).collect()
    } else {
        card.notes.push(format!(
            "the points are not equally spaced in time at constant speed (the positions differ by {:.1} % of \
             the stroke from that): the crank angle is that of the position",
            100.0 * error / expected
        ));
        by_position(&scaled, &machine.position_m)
    };
    let mut points: Vec<(f64, f64, f64)> = angles
        .iter()
        .zip(position_m.iter().zip(&load_n))
        .map(|(angle, (position, load))| (angle.rem_euclid(360.0), *position, *load))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.dedup_by(|next, one| next.0 - one.0 < 1e-6);
    card.turn_deg = points.iter().map(|(angle, ..)| *angle).collect();
    card.position_m = points.iter().map(|(_, position, _)| *position).collect();
    card.load_n = points.iter().map(|(.., load)| *load).collect();
    let at = |angle: f64| position_at(&machine.position_m, angle);
    card.expected_m = card.turn_deg.iter().map(|angle| at(*angle)).collect();
    card.csv = csv(&card);
    Ok(card)
}

/// Checks that the stroke of a card is that of the case.
fn check_stroke(
    path: &Path,
    stroke: f64,
    expected: f64,
    notes: &mut Vec<String>,
) -> Result<(), CaseError> {
    let off = stroke / expected - 1.0;
    if off.abs() > STROKE_REFUSED || !off.is_finite() {
        let units = [
            ("inch", 0.0254),
            ("feet", 0.3048),
            ("mm", 1e-3),
            ("cm", 1e-2),
        ];
        let fits = |ratio: f64| (ratio - 1.0).abs() < STROKE_REFUSED;
        let in_unit = units
            .iter()
            .find(|(_, size)| fits(stroke * size / expected));
        let of_unit = units
            .iter()
            .find(|(_, size)| fits(stroke / size / expected));
        let help = match (in_unit, of_unit) {
            (Some((unit, _)), _) => format!(
                "the numbers fit the case as {unit}: correct `card.position` in the mapping"
            ),
            (None, Some((unit, _))) => format!(
                "the numbers fit the case as metres, not {unit}: correct `card.position` in the mapping"
            ),
            (None, None) => {
                "take the card of this machine, or correct crank.radius_m of the case".to_owned()
            }
        };
        return Err(contradiction(
            path,
            "the stroke of the card",
            format!("{stroke:.3} m"),
            format!("the kinematics of the case have {expected:.3} m"),
            &help,
        ));
    }
    if off.abs() > STROKE_NOTED {
        notes.push(format!(
            "the card has a stroke of {stroke:.3} m, the case one of {expected:.3} m ({:+.1} %): the positions \
             are scaled to the case's",
            100.0 * off
        ));
    }
    Ok(())
}

/// Checks that the points are one stroke up and down whose end meets its beginning.
fn check_loop(path: &Path, position_m: &[f64], stroke: f64) -> Result<(), CaseError> {
    let mut high = position_m.last().is_some_and(|last| *last > 0.5 * stroke);
    let mut strokes = 0;
    // the loop is closed: a stroke may begin in what the list ends with
    for position in position_m.iter().chain(position_m.first()) {
        if !high && *position > 0.75 * stroke {
            high = true;
            strokes += 1;
        } else if high && *position < 0.25 * stroke {
            high = false;
        }
    }
    let help = "cut one whole stroke, up and down, out of a copy of the file; if it is the record of a logger, \
                its gauges need columns with a name such as `Gauge 1` or a unit of strain or stress";
    if strokes != 1 {
        return Err(damaged(
            path,
            format!("the points are {strokes} strokes; a card is one"),
            help,
        ));
    }
    let steps = position_m.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let ends = position_m.first().zip(position_m.last());
    let gap = ends.map_or(0.0, |(first, last)| (first - last).abs());
    if gap > 3.0 * steps.fold(0.0, f64::max) + OPEN * stroke {
        return Err(damaged(
            path,
            format!(
                "the last point is {gap:.3} m from the first one: a part of the stroke is missing"
            ),
            help,
        ));
    }
    Ok(())
}

/// Checks that the loads of the upstroke are higher than those of the downstroke, as the fluid's weight makes
/// them; the points begin at the bottom.
fn check_order(
    path: &Path,
    position_m: &[f64],
    stroke: f64,
    load_n: &[f64],
) -> Result<(), CaseError> {
    let top = argmin(
        &position_m
            .iter()
            .map(|position| -position)
            .collect::<Vec<_>>(),
    );
    let mean = |rows: std::ops::Range<usize>| {
        let inner = rows.filter(|row| (0.1..0.9).contains(&(position_m[*row] / stroke)));
        let loads: Vec<f64> = inner.map(|row| load_n[row]).collect();
        loads.iter().sum::<f64>() / loads.len() as f64
    };
    let (up, down) = (mean(0..top), mean(top..position_m.len()));
    if up >= down {
        return Ok(());
    }
    Err(damaged(
        path,
        if up.is_finite() && down.is_finite() {
            format!(
                "the load is lower on the upstroke ({:.1} kN on average) than on the downstroke ({:.1} kN), \
                 or the points run backwards",
                1e-3 * up,
                1e-3 * down
            )
        } else {
            "the points are not a whole stroke, up and down".to_owned()
        },
        "state `card.order = \"reversed\"` in the mapping if the points run from the last to the first; check \
         which column is the load",
    ))
}

/// Returns the angle of the first point with which a crank at constant speed fits the positions best \[deg\],
/// and the root mean square of the differences that remain \[m\].
fn constant_speed(position_m: &[f64], expected_m: &[f64]) -> (f64, f64) {
    let step = 360.0 / position_m.len() as f64;
    let error = |shift: f64| {
        let difference = |(at, position): (usize, &f64)| {
            (position_at(expected_m, at as f64 * step + shift) - position).powi(2)
        };
        let sum: f64 = position_m.iter().enumerate().map(difference).sum();
        (sum / position_m.len() as f64).sqrt()
    };
    // the lowest point is within noise of bottom dead centre
    let shifts = (-400..=400).map(|hundredth| f64::from(hundredth) * 0.05);
    let tried = shifts.map(|shift| (shift, error(shift)));
    tried
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or((0.0, f64::INFINITY))
}

/// Returns the crank angle of each point by its position, up to the highest point and down after it; beside
/// the dead centres, where the position hardly changes, the angle is interpolated over the points.
fn by_position(position_m: &[f64], expected_m: &[f64]) -> Vec<f64> {
    let stroke = expected_m.iter().copied().fold(0.0, f64::max);
    let top = argmin(
        &position_m
            .iter()
            .map(|position| -position)
            .collect::<Vec<_>>(),
    );
    let summit = argmin(
        &expected_m
            .iter()
            .map(|position| -position)
            .collect::<Vec<_>>(),
    );
    let step = 360.0 / expected_m.len() as f64;
    let inverse = |position: f64, up: bool| {
        let places = if up {
            0..summit
        } else {
            summit..expected_m.len()
        };
        let offset = places.start;
        let branch = &expected_m[places];
        let at = branch.partition_point(|own| (*own < position) == up);
        let here = |index: usize| expected_m[(offset + index) % expected_m.len()];
        let before = at.saturating_sub(1);
        let (low, high) = (here(before), here(at));
        let share = if at == before {
            0.0
        } else {
            (position - low) / (high - low)
        };
        ((offset + before) as f64 + share.clamp(0.0, 1.0)) * step
    };
    let mut anchors: Vec<(f64, f64)> = Vec::new();
    for (at, position) in position_m.iter().enumerate() {
        if (DEAD..1.0 - DEAD).contains(&(position / stroke)) {
            let angle = inverse(*position, at < top);
            if anchors.last().is_none_or(|(_, last)| angle > *last) {
                anchors.push((at as f64, angle));
            }
        }
    }
    let count = position_m.len() as f64;
    let (Some(&first), Some(&last)) = (anchors.first(), anchors.last()) else {
        return Vec::new();
    };
    anchors.insert(0, (last.0 - count, last.1 - 360.0));
    anchors.push((first.0 + count, first.1 + 360.0));
    let angle = |at: usize| {
        let at = at as f64;
        let after = anchors
            .partition_point(|(place, _)| *place <= at)
            .clamp(1, anchors.len() - 1);
        let ((from, low), (to, high)) = (anchors[after - 1], anchors[after]);
        low + (high - low) * (at - from) / (to - from)
    };
    (0..position_m.len()).map(angle).collect()
}

fn position_at(expected_m: &[f64], angle: f64) -> f64 {
    let place = angle.rem_euclid(360.0) / 360.0 * expected_m.len() as f64;
    let before = crate::pumping_unit::record::whole(place.floor());
    let before = usize::try_from(before).unwrap_or_default() % expected_m.len();
    let share = place - place.floor();
    let after = expected_m[(before + 1) % expected_m.len()];
    expected_m[before] + share * (after - expected_m[before])
}

fn argmin(values: &[f64]) -> usize {
    let least = (0..values.len()).min_by(|a, b| values[*a].total_cmp(&values[*b]));
    least.unwrap_or_default()
}

/// Writes the load on equally spaced angles, on a cubic curve through the points: straight lines between some
/// hundred points would smooth the peaks of the load.
fn csv(card: &ImportedCard) -> String {
    let count = card.turn_deg.len();
    // points, counted on over the turn in both directions; the first one is 1
    let at = |place: usize| {
        let turn = match place {
            0 => -360.0,
            place if place > count => 360.0,
            _ => 0.0,
        };
        let index = (place + count - 1) % count;
        (card.turn_deg[index] + turn, card.load_n[index])
    };
    // slope of the parabola through a point and its neighbours
    let slope = |place: usize| {
        let ((x0, y0), (x1, y1), (x2, y2)) = (at(place - 1), at(place), at(place + 1));
        let (before, after) = ((y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1));
        (before * (x2 - x1) + after * (x1 - x0)) / (x2 - x0)
    };
    let mut text = "turn_deg,polished_rod_load_n\n".to_owned();
    for half in 0..720 {
        let angle = 0.5 * f64::from(half);
        let passed = card.turn_deg.partition_point(|own| *own <= angle);
        // before the first point the curve is that between the last one and it
        let (from, x) = if passed == 0 {
            (count, angle + 360.0)
        } else {
            (passed, angle)
        };
        let ((x0, y0), (x1, y1)) = (at(from), at(from + 1));
        let (width, rise) = (x1 - x0, y1 - y0);
        let share = (x - x0) / width;
        let ends = [slope(from), slope(from % count + 1)];
        let [first, last] = ends.map(|slope| slope * width - rise);
        let bend = share * (1.0 - share) * (first * (1.0 - share) - last * share);
        let _infallible = writeln!(text, "{angle:.1},{:.1}", y0 + share * rise + bend);
    }
    text
}

/// Reads the columns of a table.
fn table(document: &Document, path: &Path, mapping: &CardMapping) -> Result<Points, CaseError> {
    let (Some(layout), Some(position), Some(load)) =
        (&mapping.table, &mapping.card.position, &mapping.card.load)
    else {
        return Err(document.field(
            &[DocumentStep::Key("card")],
            "{ .. }",
            "a table with `position` and `load`, each { column = \"..\", unit = \"..\" }",
            "state both columns",
        ));
    };
    let unit = |key: &'static str, unit: &str, to: &str, allowed: &str| {
        logger::factor(unit, to).ok_or_else(|| {
            document.field(
                &[
                    DocumentStep::Key("card"),
                    DocumentStep::Key(key),
                    DocumentStep::Key("unit"),
                ],
                format!("\"{unit}\""),
                allowed,
                "state the unit of the column's numbers",
            )
        })
    };
    let length = unit(
        "position",
        &position.unit,
        "m",
        "a unit of length: in, ft, mm, m",
    )?;
    let force = unit("load", &load.unit, "N", "a unit of force: lbf, kN, kgf, N")?;
    let table = logger::read(path, layout, None, &[&position.column, &load.column])?;
    let [positions, loads] = table.columns.as_slice() else {
        return Err(damaged(path, "no columns", "copy it again"));
    };
    let both = positions.iter().zip(loads);
    let known = both.filter(|(position, load)| !(position.is_nan() || load.is_nan()));
    let (position_m, load_n) = known.map(|(p, l)| (p * length, l * force)).unzip();
    Ok(Points {
        short: table.short,
        position_m,
        load_n,
        strokes_per_minute: None,
    })
}

/// Returns whether a text is a card in Theta's format: the number of points alone in the first line.
pub(super) fn is_theta(text: &str) -> bool {
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let count = lines.next().and_then(|line| line.parse::<usize>().ok());
    let pair = lines.next().map(numbers);
    count.is_some_and(|count| count > 2)
        && pair.is_some_and(|pair| pair.iter().flatten().count() == 2)
}

/// Returns the cells of a line; `None` for each that is no number.
fn numbers(line: &str) -> Vec<Option<f64>> {
    let cells = line
        .split([',', ' ', '\t', ';'])
        .filter(|cell| !cell.is_empty());
    let number = |cell: &str| cell.parse().ok().filter(|value: &f64| value.is_finite());
    cells.map(number).collect()
}

/// Reads a card in Theta's format (`.DYN`): the number of points, the points as position \[in\] and load
/// \[lbf\] in equal steps of time, the counterbalance effect, the strokes per minute.
fn theta(path: &Path) -> Result<Points, CaseError> {
    let text = logger::content(path)?;
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty());
    let count = lines
        .next()
        .and_then(|(_, line)| line.trim().parse::<usize>().ok());
    let Some(count) = count.filter(|_| is_theta(&text)) else {
        return Err(damaged(
            path,
            "line 1 is not the number of points, or line 2 not a pair of position and load",
            "state `[table]` with `card.position` and `card.load` in the mapping for a table of another format",
        ));
    };
    let size = |unit: &str, to: &str| logger::factor(unit, to).unwrap_or(f64::NAN);
    let (inch, pound) = (size("in", "m"), size("lbf", "N"));
    let mut points = Points {
        short: 0,
        position_m: Vec::new(),
        load_n: Vec::new(),
        strokes_per_minute: None,
    };
    for point in 1..=count {
        let Some((line, row)) = lines.next() else {
            return Err(damaged(
                path,
                format!("the file ends after {} points of {count}", point - 1),
                "copy the file again from its source",
            ));
        };
        let pair = numbers(row);
        let [Some(position), Some(load)] = pair.as_slice() else {
            return Err(damaged(
                path,
                format!(
                    "line {}, point {point} of {count}: `{}` is not a position and a load",
                    line + 1,
                    row.trim()
                ),
                "correct a copy of the file, or export it again",
            ));
        };
        points.position_m.push(position * inch);
        points.load_n.push(load * pound);
    }
    let rest: Vec<Vec<Option<f64>>> = lines.map(|(_, line)| numbers(line)).collect();
    if rest
        .first()
        .is_some_and(|line| line.iter().flatten().count() == 2)
    {
        return Err(damaged(
            path,
            format!("there are more points than the {count} that line 1 states"),
            "correct the number in a copy of the file, or export it again",
        ));
    }
    let rest: Vec<f64> = rest.into_iter().flatten().flatten().collect();
    // a measured counterbalance effect is followed by its load and its place
    let speed = match rest.first() {
        Some(flag) if flag.abs() > 0.5 => rest.get(3),
        _ => rest.get(1),
    };
    points.strokes_per_minute = speed.copied().filter(|speed| *speed > 0.0);
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Position of a slider crank, which is at rest at 0 and at 180 deg.
    fn position(angle: f64) -> f64 {
        let (sin, cos) = angle.to_radians().sin_cos();
        2.0 * (1.0 - cos) + 0.2 * sin * sin
    }

    fn load(angle: f64) -> f64 {
        50e3 + 20e3 * (angle - 20.0).to_radians().sin() + 3e3 * (5.0 * angle).to_radians().cos()
    }

    fn machine() -> Machine {
        Machine {
            speed_rpm: 5.0,
            position_m: (0..720)
                .map(|half| position(0.5 * f64::from(half)))
                .collect(),
        }
    }

    fn points(angles: impl Iterator<Item = f64>, scale: f64) -> Points {
        let (position_m, load_n) = angles.map(|a| (scale * position(a) - 1.0, load(a))).unzip();
        Points {
            short: 0,
            position_m,
            load_n,
            strokes_per_minute: None,
        }
    }

    fn largest_error(card: &ImportedCard) -> f64 {
        let rows = card.csv.lines().skip(1).map(|line| {
            let (angle, found) = line.split_once(',').unwrap();
            (found.parse::<f64>().unwrap() - load(angle.parse().unwrap())).abs()
        });
        rows.fold(0.0, f64::max)
    }

    /// Checks that a card in equal steps of time or of position, from the bottom or elsewhere, and with a
    /// stroke that is slightly off, gives the load over the crank angle.
    #[test]
    fn the_load_over_the_crank_angle_comes_back() {
        let path = Path::new("card");
        let steps = |from: f64| (0..240).map(move |at| from + 1.5 * f64::from(at));
        for from in [0.0, 0.7, 77.0, 200.0] {
            let card = over_angle(path, points(steps(from), 1.03), &machine()).unwrap();
            assert!(
                largest_error(&card) < 200.0,
                "{from}: {}",
                largest_error(&card)
            );
            assert!(card.notes[0].contains("stroke of 4.12"), "{:?}", card.notes);
        }
        // dense in the middle of the strokes
        let uneven = (0..240).map(|at| {
            let angle = 1.5 * f64::from(at);
            angle + 6.0 * (2.0 * angle).to_radians().sin()
        });
        let card = over_angle(path, points(uneven, 1.0), &machine()).unwrap();
        assert!(
            card.notes[0].contains("not equally spaced"),
            "{:?}",
            card.notes
        );
        assert!(largest_error(&card) < 700.0, "{}", largest_error(&card));
    }

    #[test]
    fn cards_that_cannot_be_of_the_machine_are_refused() {
        let path = Path::new("card");
        let steps = || (0..240).map(|at| 1.5 * f64::from(at));
        let error = |points: Points| {
            over_angle(path, points, &machine())
                .unwrap_err()
                .to_string()
        };
        let inches = error(points(steps(), 1.0 / 0.0254));
        assert!(
            inches.contains("157.480 m") && inches.contains("have 4.000 m"),
            "{inches}"
        );
        assert!(inches.contains("as inch"), "{inches}");
        let backwards = error(points(steps().map(|angle| 360.0 - angle), 1.0));
        assert!(backwards.contains("card.order"), "{backwards}");
        let few = error(points((0..20).map(|at| 18.0 * f64::from(at)), 1.0));
        assert!(few.contains("20 points"), "{few}");
    }

    #[test]
    fn faults_of_a_theta_file_name_the_line() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let read = |text: &str| {
            std::fs::write(file.path(), text).unwrap();
            theta(file.path())
        };
        let good =
            read("3\n0.0, 10000\n 157.5, 20000\n80 15000\n1\n9000\n0.5\n4.9\n157.5\n0\n0\n24\n")
                .unwrap();
        assert_eq!(good.strokes_per_minute, Some(4.9));
        assert!((good.position_m[1] - 4.0005).abs() < 1e-9);
        assert!((good.load_n[0] - 44_482.216_152_605).abs() < 1e-6);
        let cut = read("4\n0.0, 10000\n157.5, 20000\n")
            .unwrap_err()
            .to_string();
        assert!(cut.contains("after 2 points of 4"), "{cut}");
        let bad = read("3\n0.0, 10000\n157.5\n80, 15000\n")
            .unwrap_err()
            .to_string();
        assert!(bad.contains("line 3, point 2 of 3"), "{bad}");
    }
}
