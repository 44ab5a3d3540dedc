//! Roles of the columns of a raw file, by their names and units.
use super::logger::{self, Columns};

/// Quantity that a column holds, by its name and unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// Crank angle.
    Angle,
    /// One pulse a turn.
    Pulse,
    /// Stress or strain of a gauge, with its number where the name has one.
    Gauge(Option<u8>),
    /// Position of the polished rod.
    Position,
    /// Load of the polished rod.
    Load,
    /// Torque of the crank.
    Torque,
}

/// Words by which a column of a role is recognised, in lower case.
const WORDS: [(Role, &[&str]); 6] = [
    (
        Role::Pulse,
        &[
            "pulse", "puls", "impuls", "index", "trigger", "hall", "tacho", "proxim", "bdc", "tdc",
        ],
    ),
    (Role::Torque, &["torque", "moment", "drehmoment"]),
    (
        Role::Gauge(None),
        &[
            "dms", "strain", "stress", "gauge", "gage", "sg", "dehnung", "spannung",
        ],
    ),
    (
        Role::Angle,
        &["crank", "kurbel", "angle", "winkel", "phase"],
    ),
    (
        Role::Position,
        &[
            "position",
            "pos",
            "weg",
            "stroke",
            "hub",
            "displacement",
            "travel",
            "length",
        ],
    ),
    (Role::Load, &["load", "last", "kraft", "force", "weight"]),
];

/// Words of columns that resemble a role and are another quantity: of the pump, the motor, limits, peaks.
const OTHERS: [&str; 17] = [
    "pump",
    "downhole",
    "motor",
    "peak",
    "max",
    "maximum",
    "min",
    "minimum",
    "permissible",
    "allowable",
    "temp",
    "temperature",
    "pressure",
    "druck",
    "speed",
    "current",
    "beam",
];

/// Words by which one of several columns of a role is preferred.
const PREFERRED: [&str; 10] = [
    "crank",
    "kurbel",
    "polished",
    "rod",
    "surface",
    "stange",
    "polierstange",
    "prl",
    "length",
    "weight",
];

/// Returns the words of a column's name, in lower case and without its unit.
fn words(name: &str) -> Vec<String> {
    let bare = name.split(['[', '(', '{']).next().unwrap_or_default();
    let lower = bare.to_lowercase();
    lower
        .split(|sign: char| !sign.is_alphabetic())
        .map(str::to_owned)
        .collect()
}

/// Returns the role of a column; `None` where neither name nor unit tell it, or the two contradict each other.
pub(super) fn role(name: &str, unit: Option<&str>) -> Option<Role> {
    let of = |other: &str| unit.is_none_or(|unit| logger::factor(unit, other).is_some());
    let words = words(name);
    let has = |known: &&str| {
        let within = |word: &str| word.len() > 3 && known.len() > 3 && word.contains(*known);
        words.iter().any(|word| word == known || within(word))
    };
    if words.iter().any(|word| OTHERS.contains(&word.as_str())) {
        return None;
    }
    let bare = name.split(['[', '(', '{']).next().unwrap_or_default();
    let gauge = Role::Gauge(number(bare));
    let stress = of("m/m") || of("MPa");
    let said = WORDS.iter().find(|(_, known)| known.iter().any(has));
    match said.map(|(role, _)| *role) {
        Some(Role::Pulse) => Some(Role::Pulse),
        Some(Role::Gauge(_)) => stress.then_some(gauge),
        Some(Role::Angle) => of("deg").then_some(Role::Angle),
        Some(Role::Position) => of("m").then_some(Role::Position),
        Some(Role::Load) => of("N").then_some(Role::Load),
        Some(Role::Torque) => of("N.m").then_some(Role::Torque),
        None if unit.is_none() => None,
        None if stress => Some(gauge),
        None if of("deg") => Some(Role::Angle),
        None if of("N.m") => Some(Role::Torque),
        None if of("N") => Some(Role::Load),
        None if of("m") => Some(Role::Position),
        None => None,
    }
}

/// Returns the place of the column of a role. Of several the one with a preferred word is meant; where that
/// does not decide, their names are the error.
pub(super) fn place(
    columns: &Columns,
    roles: &[Option<Role>],
    wanted: Role,
) -> Result<Option<usize>, String> {
    let all: Vec<usize> = (0..roles.len())
        .filter(|at| roles[*at] == Some(wanted))
        .collect();
    let prefers = |at: &&usize| {
        let words = words(&columns.names[**at]);
        words.iter().any(|word| PREFERRED.contains(&word.as_str()))
    };
    let preferred: Vec<usize> = all.iter().filter(prefers).copied().collect();
    match (all.as_slice(), preferred.as_slice()) {
        ([], _) => Ok(None),
        ([one], _) | (_, [one]) => Ok(Some(*one)),
        _ => {
            let names = all.iter().map(|at| quoted(&columns.names[*at]));
            Err(names.collect::<Vec<_>>().join(", "))
        }
    }
}

/// Quotes a text for TOML.
pub(super) fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// Returns the number of a gauge in the name of its column: the last one of 1 to 4 that stands alone.
fn number(name: &str) -> Option<u8> {
    // a repeated name is told apart by a place behind it, which is no number of a gauge
    let name = match name.rsplit_once('#') {
        Some((repeated, _)) if repeated.ends_with(|sign: char| !sign.is_whitespace()) => repeated,
        _ => name,
    };
    let groups = name.split(|sign: char| !sign.is_ascii_digit());
    let mut numbers = groups.rev().filter_map(|digits| digits.parse::<u8>().ok());
    numbers.find(|number| (1..=4).contains(number))
}

#[cfg(test)]
mod tests {
    use super::{Role, role};

    #[test]
    fn columns_are_recognised_by_name_and_unit() {
        for (name, unit, expected) in [
            ("DMS1 [\u{b5}m/m]", Some("um/m"), Some(Role::Gauge(Some(1)))),
            ("Gauge 3", None, Some(Role::Gauge(Some(3)))),
            ("stress_4_mpa", Some("MPa"), Some(Role::Gauge(Some(4)))),
            ("CH2", Some("um/m"), Some(Role::Gauge(Some(2)))),
            ("Kurbelwinkel [\u{b0}]", Some("deg"), Some(Role::Angle)),
            ("crank_deg", Some("deg"), Some(Role::Angle)),
            ("Index pulse", Some("V"), Some(Role::Pulse)),
            ("polished_rod_position_m", Some("m"), Some(Role::Position)),
            ("Pos", Some("in"), Some(Role::Position)),
            ("crank_torque_nm", Some("N.m"), Some(Role::Torque)),
            ("PRL (lbs)", Some("lbf"), Some(Role::Load)),
            ("weight", None, Some(Role::Load)),
            ("Spannung", Some("V"), None),
            ("Alarm", None, None),
            ("Motor torque", Some("N.m"), None),
            ("Tubing pressure 4", Some("psi"), None),
            ("SG1 temp", None, None),
            ("Crank speed", Some("rpm"), None),
            ("Phase current", None, None),
            ("Pump load", Some("lbf"), None),
        ] {
            assert_eq!(role(name, unit), expected, "{name}");
        }
    }
}
