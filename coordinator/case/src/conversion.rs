//! Parsing of units in common notation, and conversion factors between units.

/// Unit of measurement: its factor to SI units, and its exponents of metre, kilogram, second, radian and
/// volt.
type Size = (f64, [f64; 5]);

const LENGTH: [f64; 5] = [1.0, 0.0, 0.0, 0.0, 0.0];
const MASS: [f64; 5] = [0.0, 1.0, 0.0, 0.0, 0.0];
const TIME: [f64; 5] = [0.0, 0.0, 1.0, 0.0, 0.0];
const ANGLE: [f64; 5] = [0.0, 0.0, 0.0, 1.0, 0.0];
const FORCE: [f64; 5] = [1.0, 1.0, -2.0, 0.0, 0.0];
const STRESS: [f64; 5] = [-1.0, 1.0, -2.0, 0.0, 0.0];
const FREQUENCY: [f64; 5] = [0.0, 0.0, -1.0, 0.0, 0.0];
const VOLTAGE: [f64; 5] = [0.0, 0.0, 0.0, 0.0, 1.0];

/// Unit symbols in lower case, as they occur in keys of case files, with their factors to SI units and
/// dimensions.
const SYMBOLS: &[(&str, f64, [f64; 5])] = &[
    ("m", 1.0, LENGTH),
    ("mm", 1e-3, LENGTH),
    ("cm", 1e-2, LENGTH),
    ("um", 1e-6, LENGTH),
    ("in", 0.0254, LENGTH),
    ("inch", 0.0254, LENGTH),
    ("ft", 0.3048, LENGTH),
    ("kg", 1.0, MASS),
    ("g", 1e-3, MASS),
    ("t", 1e3, MASS),
    ("lb", 0.453_592_37, MASS),
    ("s", 1.0, TIME),
    ("ms", 1e-3, TIME),
    ("min", 60.0, TIME),
    ("h", 3600.0, TIME),
    ("d", 86_400.0, TIME),
    ("rad", 1.0, ANGLE),
    ("deg", std::f64::consts::PI / 180.0, ANGLE),
    ("n", 1.0, FORCE),
    ("rev", std::f64::consts::TAU, ANGLE),
    ("dan", 10.0, FORCE),
    ("lbf", 4.448_221_615_260_5, FORCE),
    ("kip", 4_448.221_615_260_5, FORCE),
    ("kgf", 9.806_65, FORCE),
    ("tf", 9_806.65, FORCE),
    ("pa", 1.0, STRESS),
    ("psi", 6_894.757_293_168, STRESS),
    ("ksi", 6_894_757.293_168, STRESS),
    ("bar", 1e5, STRESS),
    ("hz", 1.0, FREQUENCY),
    ("rpm", 1.0 / 60.0, FREQUENCY),
    ("v", 1.0, VOLTAGE),
    ("mv", 1e-3, VOLTAGE),
];

/// Prefixes of newtons and pascals and their factors; `m` means mega, since milli is not used with these
/// units.
const MULTIPLES: [(&str, f64); 3] = [("k", 1e3), ("m", 1e6), ("g", 1e9)];

/// Returns the factor to SI units and the dimensions of a unit symbol.
fn symbol(name: &str) -> Option<Size> {
    let find = |name: &str| SYMBOLS.iter().find(|(own, ..)| *own == name);
    if let Some((_, size, measure)) = find(name) {
        return Some((*size, *measure));
    }
    MULTIPLES.iter().find_map(|(prefix, times)| {
        let base = name
            .strip_prefix(prefix)
            .filter(|base| ["n", "pa"].contains(base))?;
        find(base).map(|(_, size, measure)| (times * size, *measure))
    })
}

/// Returns the factor that converts a value from one unit to another; `None` if a unit is not known, the
/// dimensions differ or the units are equal. Units are written as `N/mm` and `kN.m/rad`, or as the suffix of
/// a key: `n_per_mm`, `kg_m2`.
pub fn factor(from: &str, to: &str) -> Option<f64> {
    ratio(from, to).filter(|ratio| ratio.total_cmp(&1.0).is_ne())
}

/// Returns the ratio of two units, 1 for equal ones; `None` if a unit is not known or the dimensions differ.
pub fn ratio(from: &str, to: &str) -> Option<f64> {
    let ((from, measure), (to, other)) = (size(from)?, size(to)?);
    let mut powers = measure.iter().zip(other);
    let alike = powers.all(|(a, b)| (a - b).abs() < 1e-9);
    alike.then(|| from / to)
}

/// Returns the remedy for a value that is stated in the unit `from` where `to` is expected.
pub fn convert(from: &str, to: &str) -> String {
    factor(from, to).map_or_else(
        || format!("did you mean `{to}`?"),
        |factor| {
            format!(
                "write `{to}`, and multiply the values by {}",
                digits(factor)
            )
        },
    )
}

/// Returns the remedy for a key that differs from a known key only by its unit, such as `radius_mm` for
/// `radius_m`.
pub fn convert_key(key: &str, known: &[&str]) -> Option<String> {
    let mut ends = key.match_indices('_').map(|(at, _)| key.split_at(at + 1));
    ends.find_map(|(stem, unit)| {
        let mut known = known.iter();
        known.find_map(|other| {
            let factor = factor(unit, other.strip_prefix(stem)?)?;
            let factor = digits(factor);
            Some(format!(
                "write `{other}`, and multiply the value by {factor}"
            ))
        })
    })
}

/// Formats a factor with at most twelve significant digits, without trailing zeros.
fn digits(factor: f64) -> String {
    let rounded: f64 = format!("{factor:.11e}").parse().unwrap_or(factor);
    if (1e-4..1e7).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// Returns the factor to SI units and the dimensions of a composite unit, such as `N/mm`.
fn size(text: &str) -> Option<Size> {
    let text = text
        .to_lowercase()
        .replace("_per_", "/")
        .replace(['_', '*', ' '], ".");
    let mut whole: Size = (1.0, [0.0; 5]);
    for (place, product) in text.split('/').enumerate() {
        for part in product.split('.').filter(|part| !part.is_empty()) {
            // the 1.5 of `m^1.5` was cut in two
            if place > 0 && part == "5" && product.contains("^1.5") {
                continue;
            }
            let end = part.find(|c: char| c == '^' || c.is_ascii_digit());
            let (name, power) = part.split_at(end.unwrap_or(part.len()));
            let power = match power.trim_start_matches('^') {
                "" => 1.0,
                "1" if product.contains("^1.5") => 1.5,
                power => power.parse().ok()?,
            };
            let (factor, measure) = symbol(name)?;
            let power = if place == 0 { power } else { -power };
            whole.0 *= factor.powf(power);
            for (all, own) in whole.1.iter_mut().zip(measure) {
                *all += power * own;
            }
        }
    }
    Some(whole)
}

#[cfg(test)]
mod tests {
    use super::{convert, convert_key, factor};

    #[test]
    fn units_that_people_have_are_converted() {
        for (from, to, expected) in [
            ("N/mm", "N/m", 1e3),
            ("kN/m", "N/m", 1e3),
            ("lbf/in", "N/m", 175.126_835_246_476),
            ("kN.m/rad", "N.m/deg", 17.453_292_519_943),
            ("N.s/mm", "N.s/m", 1e3),
            ("N/mm^1.5", "N/m^1.5", 31_622.776_601_684),
            ("kN.m", "N.m", 1e3),
            ("mm", "m", 1e-3),
            ("t_m2", "kg_m2", 1e3),
            ("lb", "kg", 0.453_592_37),
            ("kn_m", "n_m", 1e3),
            ("rad", "deg", 57.295_779_513_082),
            ("in", "m", 0.0254),
        ] {
            let found = factor(from, to).unwrap_or_default();
            assert!(
                (found / expected - 1.0).abs() < 1e-12,
                "{from} in {to}: {found}"
            );
        }
        for (from, to) in [
            ("N/m", "N.m"),
            ("kg", "N"),
            ("furlong", "m"),
            ("N/m", "N/m"),
        ] {
            assert_eq!(factor(from, to), None, "{from} in {to}");
        }
    }

    #[test]
    fn the_remedy_says_the_factor() {
        let said = convert("N/mm", "N/m");
        assert_eq!(said, "write `N/m`, and multiply the values by 1000");
        assert_eq!(convert("N/mn", "N/m"), "did you mean `N/m`?");
        let known = ["center_x_m", "radius_m", "tilt_deg"];
        let said = convert_key("radius_mm", &known);
        let expected = "write `radius_m`, and multiply the value by 0.001";
        assert_eq!(said.as_deref(), Some(expected));
        let said = convert_key("tilt_rad", &known);
        let expected = "write `tilt_deg`, and multiply the value by 57.2957795131";
        assert_eq!(said.as_deref(), Some(expected));
        assert_eq!(convert_key("radius", &known), None);
        assert_eq!(convert_key("radius_kg", &known), None);
    }
}
