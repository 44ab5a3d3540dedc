//! Roles of the columns of a raw file, by their names and units.
use super::logger;

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

/// Returns the role of a column; `None` where neither name nor unit tell it.
pub(super) fn role(name: &str, unit: Option<&str>) -> Option<Role> {
    let of = |other: &str| unit.is_some_and(|unit| logger::factor(unit, other).is_some());
    let bare = name.split(['[', '(', '{']).next().unwrap_or_default();
    let lower = bare.to_lowercase();
    let words: Vec<&str> = lower.split(|sign: char| !sign.is_alphabetic()).collect();
    let has = |known: &&str| {
        words
            .iter()
            .any(|word| word == known || word.len() > 3 && known.len() > 3 && word.contains(*known))
    };
    let voltage = of("V");
    let stress = of("m/m") || of("MPa");
    let gauge = Role::Gauge(number(bare));
    let said = WORDS.iter().find(|(_, known)| known.iter().any(has));
    match said.map(|(role, _)| *role) {
        // a second word for voltage, in German
        Some(Role::Gauge(_)) if voltage => None,
        Some(Role::Gauge(_)) => Some(gauge),
        None | Some(Role::Angle) if stress => Some(gauge),
        Some(role) => Some(role),
        None if of("deg") => Some(Role::Angle),
        None if of("N.m") => Some(Role::Torque),
        None if of("N") => Some(Role::Load),
        None if of("m") => Some(Role::Position),
        None => None,
    }
}

/// Returns the number of a gauge in the name of its column: the last one of 1 to 4 that stands alone.
fn number(name: &str) -> Option<u8> {
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
        ] {
            assert_eq!(role(name, unit), expected, "{name}");
        }
    }
}
