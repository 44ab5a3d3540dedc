//! Parsing of numbers as written by programs, including Fortran's formats.

/// Parses a finite number: `1.5`, `.5`, `1.`, `1e3`, Fortran's `1.0D+03` and, where a three-digit exponent
/// leaves no room for its letter, `1.0+103`. Surrounding white space is allowed; any other text is refused.
pub fn number(text: &str) -> Option<f64> {
    const LONGEST: usize = 100;
    let text = text.trim();
    let plain = |letter: char| letter.is_ascii_digit() || "+-.eEdD".contains(letter);
    if text.len() > LONGEST
        || !text.chars().all(plain)
        || !text.contains(|c: char| c.is_ascii_digit())
    {
        return None;
    }
    let mut usual = text.replace(['d', 'D', 'E'], "e");
    if !usual.contains('e') {
        // a sign and three digits behind a number with a point are an exponent; `12-05` is a date
        let sign = usual.rfind(['+', '-']).filter(|at| *at > 0);
        if let Some((mantissa, exponent)) = sign.map(|at| usual.split_at(at)) {
            if !mantissa.contains('.') || exponent.len() != 4 {
                return None;
            }
            usual.insert(mantissa.len(), 'e');
        }
    }
    usual.parse().ok().filter(|value: &f64| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_are_read_as_programs_write_them() {
        for (text, value) in [
            ("1.5", 1.5),
            (" -.5 ", -0.5),
            ("1.", 1.0),
            ("+2", 2.0),
            ("1.0D+03", 1000.0),
            ("1.d0", 1.0),
            ("1.0+103", 1e103),
            ("-1.0-103", -1e-103),
            ("2.5E-3", 2.5e-3),
        ] {
            assert_eq!(number(text), Some(value), "{text}");
        }
        for text in [
            "", "1-2", "12-05", "1-102", "1.5-02", "NaN", "inf", "1e999", "1.0x", "1 2", "--1",
            "e5", "1e", "-", "0x10", "1_000",
        ] {
            assert_eq!(number(text), None, "{text}");
        }
    }
}
