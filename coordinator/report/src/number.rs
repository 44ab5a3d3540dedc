//! Number formatting shared by terminal, HTML and figures.
//!
//! Plain text only: powers of ten use Unicode superscripts, and the minus is U+2212.

/// Placeholder for a missing value.
pub const MISSING: &str = "–";

/// No-break space that keeps a number and its unit or power on one line.
const NO_BREAK: char = '\u{a0}';

/// Returns the decimal exponent of a finite, non-zero value after rounding to a number of digits.
fn exponent(value: f64, digits: i32) -> i32 {
    // formatting rounds as the printed digits will be, which log10().floor() does not
    let decimals = usize::try_from(digits - 1).unwrap_or(0);
    let text = format!("{:.decimals$e}", value.abs());
    text.split_once('e')
        .and_then(|(_, exponent)| exponent.parse().ok())
        .unwrap_or(0)
}

/// Formats an integer as Unicode superscript.
pub fn superscript(value: i32) -> String {
    value
        .to_string()
        .chars()
        .map(|digit| match digit {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '4' => '⁴',
            '5' => '⁵',
            '6' => '⁶',
            '7' => '⁷',
            '8' => '⁸',
            '9' => '⁹',
            _ => '⁰',
        })
        .collect()
}

/// Replaces the hyphen of a printed number by a minus sign.
fn signed(text: &str) -> String {
    text.strip_prefix('-')
        .map_or_else(|| text.to_owned(), |rest| format!("−{rest}"))
}

/// Formats a value with three significant digits; as a power of ten outside 0.01 to 100 000.
pub fn significant(value: f64) -> String {
    digits(value, 3)
}

/// Formats a value with three significant digits, or with as many as show two digits of a difference, such as the width of an
/// interval beside which the value stands.
pub fn precise(value: f64, difference: f64) -> String {
    /// Digits from which rounding shows.
    const MOST: i32 = 12;
    if !(difference.is_finite() && difference != 0.0 && value != 0.0) {
        return significant(value);
    }
    digits(
        value,
        (exponent(value, 3) - exponent(difference, 3) + 2).clamp(3, MOST),
    )
}

/// Formats an interval with its unit written once, and as many digits that its ends differ.
pub fn interval([low, high]: [f64; 2], symbol: &str) -> String {
    if !(low.is_finite() && high.is_finite()) {
        return MISSING.to_owned();
    }
    let [low, high] = [low, high].map(|end| precise(end, high - low));
    match symbol {
        "" | "1" => format!("{low} to {high}"),
        _ => format!("{low} to {high}{NO_BREAK}{}", unit(symbol)),
    }
}

fn digits(value: f64, digits: i32) -> String {
    if !value.is_finite() {
        return MISSING.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = exponent(value, digits);
    if !(-2..5).contains(&exponent) {
        let mantissa = value / 10_f64.powi(exponent);
        return format!(
            "{}{NO_BREAK}×{NO_BREAK}10{}",
            fixed(mantissa, usize::try_from(digits - 1).unwrap_or(0)),
            superscript(exponent)
        );
    }
    let decimals = usize::try_from(digits - 1 - exponent).unwrap_or(0);
    fixed(value, decimals)
}

/// Formats a whole number without decimals, any other with three significant digits.
pub fn integer_or_significant(value: f64) -> String {
    if (value - value.round()).abs() < 1e-9 {
        fixed(value, 0)
    } else {
        significant(value)
    }
}

/// Formats a value with a fixed number of decimals.
pub fn fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return MISSING.to_owned();
    }
    let text = format!("{value:.decimals$}");
    // "-0.00" says more than is known
    let text = if text.chars().all(|c| matches!(c, '-' | '0' | '.')) {
        text.trim_start_matches('-').to_owned()
    } else {
        text
    };
    signed(&text)
}

/// Formats a share of 1 as a percentage.
pub fn percent(share: f64) -> String {
    if !share.is_finite() {
        return MISSING.to_owned();
    }
    let decimals = usize::from(share.abs() < 0.9995);
    format!("{}{NO_BREAK}%", fixed(100.0 * share, decimals))
}

/// Formats the quotient `of / to` as a multiple: `2.49 ×`.
pub fn ratio(of: f64, to: f64) -> String {
    let ratio = of / to;
    if ratio.is_finite() {
        format!("{}{NO_BREAK}×", significant(ratio))
    } else {
        MISSING.to_owned()
    }
}

/// Typesets a unit written as in files: `kg.m2` becomes `kg·m²`, `N/m^1.5` becomes `N/m¹·⁵`.
pub fn unit(symbol: &str) -> String {
    let mut set = String::with_capacity(symbol.len() + 4);
    let mut raised = false;
    for c in symbol.chars() {
        match (c, c.to_digit(10)) {
            ('^', _) => raised = true,
            ('.', _) => set.push('·'),
            (_, Some(digit)) if raised => set.push_str(&superscript(digit.cast_signed())),
            _ => {
                // a digit behind a letter is its power, one in front is a number
                raised = c.is_alphabetic();
                set.push(c);
            }
        }
    }
    set
}

/// Typesets the square of a unit; empty where there is no unit.
pub fn squared(symbol: Option<&str>) -> String {
    match symbol {
        None | Some("" | "1") => String::new(),
        Some(compound) if compound.contains(['.', '/']) => unit(&format!("({compound})^2")),
        Some(single) => unit(&format!("{single}^2")),
    }
}

/// Formats a value with its unit; the unit `1` is not written.
pub fn quantity(value: f64, symbol: &str) -> String {
    match symbol {
        _ if !value.is_finite() => MISSING.to_owned(),
        "" | "1" => significant(value),
        _ => format!("{}{NO_BREAK}{}", significant(value), unit(symbol)),
    }
}

/// Formats a whole number with thin spaces between thousands.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut grouped = String::with_capacity(digits.len() + digits.len() / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            grouped.push('\u{202f}');
        }
        grouped.push(digit);
    }
    grouped
}

/// Formats a duration given in seconds in a suitable unit (µs to h).
pub fn duration(seconds: f64) -> String {
    if !seconds.is_finite() || seconds < 0.0 {
        MISSING.to_owned()
    } else if seconds == 0.0 {
        "0 s".to_owned()
    } else if seconds < 1e-3 {
        format!("{}{NO_BREAK}µs", significant(1e6 * seconds))
    } else if seconds < 1.0 {
        format!("{}{NO_BREAK}ms", significant(1e3 * seconds))
    } else if seconds < 100.0 {
        format!("{} s", significant(seconds))
    } else if seconds < 6000.0 {
        format!("{} min", fixed(seconds / 60.0, 1))
    } else {
        format!("{} h", fixed(seconds / 3600.0, 1))
    }
}

/// Returns the smallest and largest finite value; `None` if there is none.
pub fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .into_iter()
        .filter(|value| value.is_finite())
        .fold(None, |range, value| match range {
            None => Some((value, value)),
            Some((low, high)) => Some((low.min(value), high.max(value))),
        })
}

/// Formats a number with full precision for a CSV field; empty if missing or not finite.
pub fn field(value: Option<f64>) -> String {
    value
        .filter(|value| value.is_finite())
        .map_or_else(String::new, |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::{count, duration, fixed, percent, ratio, significant};

    #[test]
    fn three_digits_and_powers_of_ten() {
        assert_eq!(significant(3.14e8), "3.14\u{a0}×\u{a0}10⁸");
        assert_eq!(significant(-0.00123), "−1.23\u{a0}×\u{a0}10⁻³");
        assert_eq!(significant(5201.3), "5201");
        assert_eq!(significant(40.0), "40.0");
        assert_eq!(significant(0.0456), "0.0456");
        assert_eq!(significant(99_999.0), "1.00\u{a0}×\u{a0}10⁵");
        assert_eq!(significant(9.999), "10.0");
        assert_eq!(significant(f64::NAN), "–");
    }

    /// Checks that durations are formatted in a suitable unit. Regression: a diagnosis with a fast model
    /// printed `7.11 x 10^-7 s`.
    #[test]
    fn a_time_has_the_unit_that_suits_it() {
        for (seconds, said) in [
            (0.0, "0 s"),
            (7.11e-7, "0.711\u{a0}µs"),
            (5.5e-2, "55.0\u{a0}ms"),
            (1.5, "1.50 s"),
            (150.0, "2.5 min"),
            (7200.0, "2.0 h"),
        ] {
            assert_eq!(duration(seconds), said);
        }
    }

    #[test]
    fn shares_ratios_and_counts() {
        assert_eq!(percent(0.2541), "25.4\u{a0}%");
        assert_eq!(percent(1.7824), "178\u{a0}%");
        assert_eq!(ratio(7.81e8, 3.14e8), "2.49\u{a0}×");
        assert_eq!(ratio(1.0, 0.0), "–");
        assert_eq!(count(1_234_567), "1\u{202f}234\u{202f}567");
        assert_eq!(fixed(-0.001, 2), "0.00");
    }
}
