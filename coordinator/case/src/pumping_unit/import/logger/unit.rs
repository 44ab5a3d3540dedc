//! Units as they stand in headers of tables, in common notation.
use crate::conversion;

/// Spellings of units that differ from common notation in more than case, in lower case; `e` stands for the
/// letter epsilon.
const SPELLINGS: &[(&str, &str)] = &[
    ("ue", "um/m"),
    ("ustrain", "um/m"),
    ("microstrain", "um/m"),
    ("microstrains", "um/m"),
    ("ustr", "um/m"),
    ("ust", "um/m"),
    ("ud", "um/m"),
    ("in/in", "m/m"),
    ("strain", "m/m"),
    ("n/mm2", "MPa"),
    ("mpa", "MPa"),
    ("lbs", "lbf"),
    ("lb", "lbf"),
    ("pounds", "lbf"),
    ("klb", "kip"),
    ("klbs", "kip"),
    ("klbf", "kip"),
    ("kips", "kip"),
    ("kg", "kgf"),
    ("kp", "kgf"),
    ("t", "tf"),
    ("ton", "tf"),
    ("da n", "daN"),
    ("inch", "in"),
    ("inches", "in"),
    ("feet", "ft"),
    ("grad", "deg"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("turn", "rev"),
    ("revs", "rev"),
    ("revolution", "rev"),
    ("revolutions", "rev"),
    ("turns", "rev"),
    ("sec", "s"),
    ("secs", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("msec", "ms"),
    ("day", "d"),
    ("days", "d"),
    ("nm", "N.m"),
    ("knm", "kN.m"),
    ("ft-lb", "lbf.ft"),
    ("ft-lbf", "lbf.ft"),
    ("lb-ft", "lbf.ft"),
    ("lbf-ft", "lbf.ft"),
    ("in-lb", "lbf.in"),
    ("in-lbf", "lbf.in"),
    ("lb-in", "lbf.in"),
    ("lbf-in", "lbf.in"),
    ("volt", "V"),
    ("volts", "V"),
    ("v", "V"),
    ("mv", "mV"),
    ("mv/v", "mV/V"),
];

/// Dimensions of the quantities of a record, each with a unit of it.
const DIMENSIONS: &[&str] = &["m/m", "MPa", "N", "m", "deg", "s", "N.m", "V", "1/min"];

/// Returns the common notation of a unit, such as `um/m` for the sign of microstrain; `None` if it is none
/// that a measured quantity has.
pub(crate) fn normal(written: &str) -> Option<String> {
    let plain = written
        .trim()
        .trim_matches(['[', ']', '(', ')', '"', '\''])
        .to_lowercase()
        .replace(['\u{b5}', '\u{3bc}'], "u")
        .replace(['\u{3b5}', '\u{25b}', '\u{454}'], "e")
        .replace('\u{b0}', "deg")
        .replace(['\u{b7}', '*', '\u{d7}'], ".")
        .replace('\u{b2}', "2");
    let plain = plain.trim();
    if plain.is_empty() {
        return None;
    }
    if let Some((_, common)) = SPELLINGS.iter().find(|(spelling, _)| *spelling == plain) {
        return Some((*common).to_owned());
    }
    let known = |unit: &&&str| conversion::ratio(plain, unit).is_some();
    DIMENSIONS.iter().find(known)?;
    Some(match plain {
        "kn" => "kN".to_owned(),
        "n" => "N".to_owned(),
        "dan" => "daN".to_owned(),
        "kn.m" => "kN.m".to_owned(),
        "n.m" => "N.m".to_owned(),
        "kpa" => "kPa".to_owned(),
        "gpa" => "GPa".to_owned(),
        "pa" => "Pa".to_owned(),
        _ => plain.to_owned(),
    })
}

/// Returns the unit at the end of a column's name: in brackets, or after a blank, a slash, a comma or an
/// underscore.
pub(crate) fn stated(name: &str) -> Option<String> {
    let name = name.trim();
    for (open, close) in [('[', ']'), ('(', ')'), ('{', '}')] {
        if let Some((_, rest)) = name.rsplit_once(open)
            && let Some((inner, _)) = rest.split_once(close)
        {
            // what is in brackets and no unit, such as `x10 kN.m`, says that the unit is another one
            return normal(inner);
        }
    }
    [" in ", ", ", "_", " ", "/"].iter().find_map(|between| {
        let (_, last) = name.rsplit_once(between)?;
        // a single letter may be a name: the gauge `S`, the axis `m`
        normal(last).filter(|_| last.len() > 1 || name.ends_with("_m") || name.ends_with("_s"))
    })
}

/// Returns the factor from one unit to another; `None` if their dimensions differ or one is not known.
pub(crate) fn factor(from: &str, to: &str) -> Option<f64> {
    conversion::ratio(&normal(from)?, to)
}

#[cfg(test)]
mod tests {
    use super::{factor, normal, stated};

    #[test]
    fn units_in_headers_are_recognised() {
        for (written, common) in [
            ("\u{b5}m/m", "um/m"),
            ("[\u{3bc}m/m]", "um/m"),
            ("\u{b5}\u{3b5}", "um/m"),
            ("N/mm\u{b2}", "MPa"),
            ("KN", "kN"),
            ("lbs", "lbf"),
            ("\u{b0}", "deg"),
            ("kN\u{b7}m", "kN.m"),
            ("Inch", "in"),
            ("ksi", "ksi"),
        ] {
            assert_eq!(normal(written).as_deref(), Some(common), "{written}");
        }
        for written in ["", "%", "LLLL", "Alarm", "NO.", "furlong"] {
            assert_eq!(normal(written), None, "{written}");
        }
        for (name, unit) in [
            ("DMS1 [\u{b5}m/m]", Some("um/m")),
            ("Load (kN)", Some("kN")),
            ("stress_1_mpa", Some("MPa")),
            ("crank_deg", Some("deg")),
            ("time_s", Some("s")),
            ("Position/in", Some("in")),
            ("Gauge 3", None),
            ("Channel m", None),
            ("Torque (x10 kN.m)", None),
            ("Torque (1000 ft-lb)", None),
        ] {
            assert_eq!(stated(name).as_deref(), unit, "{name}");
        }
    }

    #[test]
    fn factors_of_units_that_people_have() {
        for (from, to, expected) in [
            ("ksi", "MPa", 6.894_757_293_168),
            ("kgf", "N", 9.806_65),
            ("kip", "N", 4_448.221_615_260_5),
            ("lbf.ft", "N.m", 1.355_817_948_331_4),
            ("ft", "m", 0.3048),
            ("rev", "deg", 360.0),
            ("d", "s", 86_400.0),
            ("microstrain", "m/m", 1e-6),
            ("N", "N", 1.0),
        ] {
            let found = factor(from, to).unwrap_or_default();
            assert!((found / expected - 1.0).abs() < 1e-12, "{from}: {found}");
        }
        assert_eq!(factor("kN", "m"), None);
    }
}
