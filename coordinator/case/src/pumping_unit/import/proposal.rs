//! Proposal of a mapping from the columns of a raw file: which is the angle, which the gauges, in what unit.
use super::{
    logger::{self, Columns, Layout, Sample, Table, Time},
    mapping::Edge,
    role::{Role, place, quoted, role},
};
use crate::error::CaseError;
use std::{fmt::Write as _, path::Path};

/// Proposed mapping as text, with what only a person can state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MappingProposal {
    /// Text of the mapping file, with comments.
    pub text: String,
    /// Keys that must be stated, each with its meaning; empty if the mapping is complete.
    pub open: Vec<String>,
}

/// Name of the rod position in a record.
const POSITION: &str = "polished_rod_position_m";

/// Facts about the case that a proposal uses.
#[derive(Clone, Debug)]
pub(super) struct Known {
    /// Young's modulus of the head \[GPa\].
    pub(super) young_gpa: f64,
    /// Position of the polished rod above its lowest one at equally spaced crank angles from bottom dead
    /// centre \[m\].
    pub(super) rod_position_m: Vec<f64>,
    /// The command that repeats the import.
    pub(super) command: String,
}

/// Writes the heading of a mapping and its `files` and `[table]`.
pub(super) fn heading(text: &mut String, known: &Known, files: &[String], layout: Option<&Layout>) {
    let files: Vec<String> = files.iter().map(|file| quoted(file)).collect();
    let _infallible = write!(
        text,
        "# Proposed from the content of the raw files: correct what is wrong, then repeat the import by\n\
         #   {}\nfiles = [{}]\n",
        known.command,
        files.join(", ")
    );
    let Some(layout) = layout else { return };
    text.push_str("\n[table]                              # lines are counted from 1\n");
    // a layout is strings and whole numbers
    text.push_str(&toml::to_string(layout).unwrap_or_default());
}

/// Proposes the mapping of the files of a logger, which have the layout of the first one.
///
/// # Errors
/// Returns an error for a file without a table, and cells that are no numbers.
pub(super) fn propose(
    path: &Path,
    files: &[String],
    known: &Known,
) -> Result<MappingProposal, CaseError> {
    let sample = Sample::read(path)?;
    let mut layout = logger::sniff(path, &sample)?;
    let columns = Columns::read(path, &layout)?;
    let time = logger::propose_time(&columns, &sample.rows(&layout), &layout);
    let roles: Vec<Option<Role>> = columns
        .names
        .iter()
        .zip(&columns.units)
        .map(|(name, unit)| role(name, unit.as_deref()).filter(|_| !is_time(time.as_ref(), name)))
        .collect();
    let mut open = Vec::new();
    let mut one = |wanted: Role, what: &str| {
        place(&columns, &roles, wanted).unwrap_or_else(|names| {
            open.push(format!("{what}: which of the columns {names}"));
            None
        })
    };
    let angle = one(Role::Angle, "angle.column").or_else(|| one(Role::Pulse, "angle.pulse"));
    let others = [
        (
            one(Role::Position, "curves.polished_rod_position_m"),
            POSITION,
        ),
        (
            one(Role::Torque, "curves.crank_torque_nm"),
            "crank_torque_nm",
        ),
    ];
    let curves = curves(&roles, &others);
    let mut wanted: Vec<&str> = angle.iter().map(|at| columns.names[*at].as_str()).collect();
    wanted.extend(
        curves
            .iter()
            .map(|curve| columns.names[curve.place].as_str()),
    );
    // missing numbers and the kind of the pulse are seen in the numbers alone
    let table = logger::survey(path, &layout, &wanted)?;
    layout.missing.extend(table.sentinels());
    let mut text = String::new();
    heading(&mut text, known, files, Some(&layout));
    if !table.words.is_empty() {
        let words: Vec<String> = table
            .words
            .iter()
            .map(|(line, word)| format!("{} (line {line})", quoted(word)))
            .collect();
        let _infallible = writeln!(text, "# no numbers: {}", words.join(", "));
        open.push(format!(
            "table.missing: the cells that stand for a missing value, of {}",
            words.join(", ")
        ));
    }
    write_time(&mut text, &mut open, time.as_ref());
    let direction = angle.map(|at| (at, roles[at] == Some(Role::Pulse)));
    let position = curves.iter().position(|curve| curve.name == POSITION);
    let position = position.map(|at| at + usize::from(angle.is_some()));
    let seen = (&table, position);
    write_angle(
        &mut text,
        &mut open,
        &columns,
        direction,
        seen,
        &known.rod_position_m,
    );
    text.push_str("\n[curves]\n");
    for curve in &curves {
        write_curve(&mut text, &mut open, &columns, curve, known);
    }
    if !curves.iter().any(|curve| curve.name.starts_with("stress_")) {
        text.push_str("# stress_1_mpa = { column = \"..\", unit = \"um/m\", young_gpa = 206.0 }\n");
        open.push("curves: the column of each gauge, as stress_1_mpa .. stress_4_mpa".to_owned());
    }
    let used = |place: usize| {
        let curve = curves.iter().any(|curve| curve.place == place);
        angle == Some(place) || curve || is_time(time.as_ref(), &columns.names[place])
    };
    write_unused(&mut text, &columns, used);
    Ok(MappingProposal { text, open })
}

/// Lists the columns that are not used.
fn write_unused(text: &mut String, columns: &Columns, used: impl Fn(usize) -> bool) {
    let unused = (0..columns.names.len()).filter(|place| !used(*place));
    let unused: Vec<String> = unused.map(|place| quoted(&columns.names[place])).collect();
    if !unused.is_empty() {
        let _infallible = writeln!(text, "# not used: {}", unused.join(", "));
    }
}

/// Returns whether a column states the time.
fn is_time(time: Option<&Time>, name: &str) -> bool {
    time.is_some_and(|time| {
        let named = time
            .column
            .iter()
            .chain(&time.columns)
            .chain(&time.milliseconds);
        named.into_iter().any(|column| column == name)
    })
}

/// Curve of a proposal: its name in the record, the place of its column, and whether the number of the gauge
/// is a guess.
struct ProposedCurve {
    name: String,
    place: usize,
    guessed: bool,
}

/// Returns the curves of the columns: gauges by the numbers in their names, or four of them in their order.
fn curves(roles: &[Option<Role>], others: &[(Option<usize>, &str)]) -> Vec<ProposedCurve> {
    let gauges: Vec<(usize, Option<u8>)> = roles
        .iter()
        .enumerate()
        .filter_map(|(place, role)| match role {
            Some(Role::Gauge(number)) => Some((place, *number)),
            _ => None,
        })
        .collect();
    let mut numbers: Vec<u8> = gauges.iter().filter_map(|(_, number)| *number).collect();
    let numbered = numbers.len();
    numbers.sort_unstable();
    numbers.dedup();
    // with distinct numbers those without one are other gauges
    let distinct = numbered > 0 && numbers.len() == numbered;
    let meant = |(_, number): &&(usize, Option<u8>)| !distinct || number.is_some();
    let mut all: Vec<ProposedCurve> = Vec::new();
    for (order, (place, number)) in (1_u8..=4).zip(gauges.iter().filter(meant)) {
        let number = number.filter(|_| distinct).unwrap_or(order);
        all.push(ProposedCurve {
            name: format!("stress_{number}_mpa"),
            place: *place,
            guessed: !distinct,
        });
    }
    all.sort_by(|a, b| a.name.cmp(&b.name));
    for (place, name) in others {
        if let Some(place) = *place {
            all.push(ProposedCurve {
                name: (*name).to_owned(),
                place,
                guessed: false,
            });
        }
    }
    all
}

fn write_time(text: &mut String, open: &mut Vec<String>, time: Option<&Time>) {
    text.push_str("\n[time]\n");
    if let Some(time) = time {
        // a time is strings and numbers
        text.push_str(&toml::to_string(time).unwrap_or_default());
    } else {
        text.push_str("# column = \"..\"                      # elapsed time, with unit = \"s\"\n");
        text.push_str("# rate_hz = 100.0                    # or the sampling rate, where there is no column\n");
        open.push("time: the column of the time, or `rate_hz`".to_owned());
    }
}

/// Keys of `[angle]` for a file in which no column of it was recognised.
const NO_ANGLE: &str = "# an angle:\n# column = \"..\"\n# unit = \"deg\"\n# direction = \"increasing\"\n\
             # bottom_dead_centre_deg = 0.0       # number of the column, in degrees, at bottom dead centre\n\
             # or one pulse a turn:\n# pulse = \"..\"\n# level = 2.5\n# edge = \"rising\"\n\
             # pulse_deg = 0.0                    # crank angle from bottom dead centre at that edge\n\
             # either way:\n# uncertainty_deg = 0.1              # standard deviation of that angle\n";

/// Writes `[angle]`: the column, whether it is a pulse, and what can be seen in its numbers, which are the
/// first column of the table; the rod position is another one of it.
fn write_angle(
    text: &mut String,
    open: &mut Vec<String>,
    columns: &Columns,
    angle: Option<(usize, bool)>,
    (table, position): (&Table, Option<usize>),
    rod_position_m: &[f64],
) {
    text.push_str("\n[angle]                              # of the crank\n");
    let Some((place, pulse)) = angle else {
        text.push_str(NO_ANGLE);
        open.push("angle: the column of the crank angle, or of one pulse a turn".to_owned());
        return;
    };
    let name = quoted(&columns.names[place]);
    if pulse {
        let (level, edge) = pulse_level(&table.columns[0]);
        let edge = match edge {
            Edge::Rising => "rising",
            Edge::Falling => "falling",
        };
        let _infallible = write!(
            text,
            "pulse = {name}\nlevel = {level:?}\nedge = \"{edge}\"\n\
             # pulse_deg = 0.0                    # crank angle from bottom dead centre at that edge\n"
        );
        open.push(
            "angle.pulse_deg: the crank angle at which the pulse comes, in degrees from bottom dead centre in \
             the sense of rotation"
                .to_owned(),
        );
    } else {
        let unit = columns.units[place].clone();
        let unit = unit.or_else(|| unit_by_range(&table.columns[0]).map(str::to_owned));
        let stated = if unit.is_some() { "" } else { "# " };
        if unit.is_none() {
            open.push("angle.unit: the unit of the angle, deg, rad or rev".to_owned());
        }
        let unit = unit.unwrap_or_else(|| "deg".to_owned());
        let factor = logger::factor(&unit, "deg").unwrap_or(1.0);
        let degrees: Vec<f64> = table.columns[0]
            .iter()
            .map(|value| value * factor)
            .collect();
        let known: Vec<f64> = degrees
            .iter()
            .copied()
            .filter(|value| !value.is_nan())
            .collect();
        let sum: f64 = known.windows(2).map(|pair| step(pair[0], pair[1])).sum();
        let sign = if sum < 0.0 { -1.0 } else { 1.0 };
        let direction = if sum < 0.0 {
            "decreasing"
        } else {
            "increasing"
        };
        let lowest = position.and_then(|column| {
            let angles: Vec<f64> = degrees.iter().map(|angle| sign * angle).collect();
            lowest_deg(&angles, table.columns.get(column)?, rod_position_m)
        });
        let lowest = lowest.map(|angle| {
            format!(
                "; {:.1} by the rod position",
                (sign * angle).rem_euclid(360.0)
            )
        });
        let _infallible = write!(
            text,
            "column = {name}\n{stated}unit = {}\ndirection = \"{direction}\"\n\
             # bottom_dead_centre_deg = 0.0       # number of the column, in degrees, at bottom dead centre{}\n",
            quoted(&unit),
            lowest.unwrap_or_default()
        );
        open.push(
            "angle.bottom_dead_centre_deg: the number of the column, in degrees, while the polished rod is lowest"
                .to_owned(),
        );
    }
    text.push_str("# uncertainty_deg = 0.1              # standard deviation of that angle\n");
    open.push(
        "angle.uncertainty_deg: how well that angle is known, one standard deviation in degrees"
            .to_owned(),
    );
}

/// Returns the unit of an angle whose numbers run over one turn; `None` where they do not.
fn unit_by_range(values: &[f64]) -> Option<&'static str> {
    let known = values.iter().filter(|value| !value.is_nan());
    let lowest = known.clone().copied().fold(f64::INFINITY, f64::min);
    let highest = known.copied().fold(f64::NEG_INFINITY, f64::max);
    let turns = [("deg", 360.0), ("rad", std::f64::consts::TAU), ("rev", 1.0)];
    let fits = |(_, turn): &(&str, f64)| (0.95..1.001).contains(&((highest - lowest) / turn));
    turns.iter().find(|turn| fits(turn)).map(|(unit, _)| *unit)
}

/// Returns the step from one angle to the next one, at most half a turn \[deg\].
fn step(before: f64, after: f64) -> f64 {
    (after - before + 180.0).rem_euclid(360.0) - 180.0
}

/// Returns the angle at which a recorded rod position begins its turn \[deg\]: the shift between its fundamental
/// over an increasing angle and that of the kinematics, which begin at bottom dead centre.
pub(super) fn lowest_deg(
    angle_deg: &[f64],
    position: &[f64],
    rod_position_m: &[f64],
) -> Option<f64> {
    let samples: Vec<(f64, f64)> = angle_deg
        .iter()
        .zip(position)
        .filter(|(angle, position)| !(angle.is_nan() || position.is_nan()))
        .map(|(angle, position)| (*angle, *position))
        .collect();
    // whole turns only, since a part of one has a fundamental of its own
    let span: f64 = samples
        .windows(2)
        .map(|pair| step(pair[0].0, pair[1].0))
        .sum();
    let whole = 360.0 * (span / 360.0 + 0.01).floor();
    let mut passed = 0.0;
    let phase =
        |sum: [f64; 2]| (sum[0].hypot(sum[1]) > 0.0).then(|| sum[1].atan2(sum[0]).to_degrees());
    let mut sum = [0.0; 2];
    for pair in samples.windows(2) {
        let width = step(pair[0].0, pair[1].0);
        if passed + width > whole + 1e-9 {
            break;
        }
        passed += width;
        let (sin, cos) = pair[0].0.to_radians().sin_cos();
        sum = [
            sum[0] + width * pair[0].1 * cos,
            sum[1] + width * pair[0].1 * sin,
        ];
    }
    let count = rod_position_m.len() as f64;
    let mut kinematics = [0.0; 2];
    for (at, position) in rod_position_m.iter().enumerate() {
        let (sin, cos) = (std::f64::consts::TAU * at as f64 / count).sin_cos();
        kinematics = [
            kinematics[0] + position * cos,
            kinematics[1] + position * sin,
        ];
    }
    Some((phase(sum)? - phase(kinematics)?).rem_euclid(360.0))
}

/// Returns the level of a pulse, half way between its ends, and the edge at which it begins: away from the
/// level at which the signal mostly rests.
fn pulse_level(values: &[f64]) -> (f64, Edge) {
    let mut sorted: Vec<f64> = values
        .iter()
        .copied()
        .filter(|value| !value.is_nan())
        .collect();
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| -> f64 {
        let last = sorted.len().saturating_sub(1) as f64;
        let place = crate::pumping_unit::record::whole((share * last).round());
        usize::try_from(place)
            .ok()
            .and_then(|place| sorted.get(place))
            .copied()
            .unwrap_or_default()
    };
    let [low, median, high] = [at(0.0), at(0.5), at(1.0)];
    let level = 0.5 * (low + high);
    // two significant digits are enough for a threshold
    let unit = libm::pow(10.0, (high - low).abs().max(1e-12).log10().floor() - 1.0);
    let edge = if median > level {
        Edge::Falling
    } else {
        Edge::Rising
    };
    ((level / unit).round() * unit, edge)
}

fn write_curve(
    text: &mut String,
    open: &mut Vec<String>,
    columns: &Columns,
    curve: &ProposedCurve,
    known: &Known,
) {
    let column = quoted(&columns.names[curve.place]);
    let Some(unit) = &columns.units[curve.place] else {
        let example = if curve.name.starts_with("stress_") {
            "\"um/m\", young_gpa = 206.0"
        } else {
            "\"..\""
        };
        let _infallible = writeln!(
            text,
            "# {} = {{ column = {column}, unit = {example} }}",
            curve.name
        );
        open.push(format!(
            "curves.{}: the unit of column {column}, or remove the line",
            curve.name
        ));
        return;
    };
    let strain = logger::factor(unit, "m/m").is_some();
    let bridge = unit.eq_ignore_ascii_case("mV/V");
    let arms = if bridge {
        ", gauge_factor = 2.0, active_arms = 1"
    } else {
        ""
    };
    let young = if strain {
        format!("{arms}, young_gpa = {:?}", known.young_gpa)
    } else {
        String::new()
    };
    let open_sign = if curve.guessed || bridge { "# " } else { "" };
    let _infallible = writeln!(
        text,
        "{open_sign}{} = {{ column = {column}, unit = {}{young} }}",
        curve.name,
        quoted(unit)
    );
    if curve.guessed {
        open.push(format!(
            "curves.{}: the column of this gauge; {column} is a guess by the order of the columns",
            curve.name
        ));
    }
    if bridge {
        open.push(format!(
            "curves.{}: gauge factor and number of active arms of the bridge (1 quarter, 2 half, 4 full)",
            curve.name
        ));
    }
}
