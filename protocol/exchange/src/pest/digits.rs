//! Formatting of numbers for fields of limited width, with as many digits as fit.

/// Relative error from which a field is so narrow that the zero before the point gives way to a digit: JSON does not allow
/// that, and fixed columns of Fortran do.
const ROUGH: f64 = 1e-4;

/// Formats a value in at most `width` characters: exactly if possible, otherwise as accurately as the field
/// allows; `None` if not even one digit fits.
pub fn fit(value: f64, width: usize) -> Option<String> {
    if !value.is_finite() {
        return None;
    }
    let exact = [format!("{value}"), format!("{value:e}")];
    if let Some(text) = exact
        .into_iter()
        .filter(|text| text.len() <= width)
        .min_by_key(String::len)
    {
        return Some(pointed(text, width));
    }
    let off = |text: &String| {
        text.parse::<f64>()
            .map_or(f64::INFINITY, |read| (read - value).abs())
    };
    let rounded = |is_bare: bool| {
        let texts = (0..=17_usize).flat_map(move |digits| {
            let after = digits.saturating_sub(1);
            let plain = format!("{value:.digits$}");
            let plain = if is_bare {
                plain.replacen("0.", ".", 1)
            } else {
                plain
            };
            [plain, format!("{value:.after$e}")]
        });
        let fitting = texts.filter(|text| text.len() <= width && crate::number(text).is_some());
        fitting.min_by(|a, b| off(a).total_cmp(&off(b)).then(a.len().cmp(&b.len())))
    };
    let best = rounded(false);
    let is_rough = |text: &String| off(text) > ROUGH * value.abs();
    let best = if value.abs() < 1.0 && best.as_ref().is_none_or(is_rough) {
        rounded(true)
    } else {
        best
    }?;
    // zero in place of a number that is none is no digit of it
    let lost = value != 0.0 && best.parse::<f64>().is_ok_and(|read| read == 0.0);
    (!lost).then(|| pointed(best, width))
}

/// Appends `.0` where there is room, so that programs that distinguish integers from real numbers read a real
/// number.
fn pointed(text: String, width: usize) -> String {
    if text.contains(['.', 'e']) || text.len() + 2 > width {
        text
    } else {
        text + ".0"
    }
}

#[cfg(test)]
mod tests {
    use super::fit;
    use proptest::prelude::*;

    #[test]
    fn as_many_digits_as_fit_are_written() {
        for (value, width, text) in [
            (12.5, 17, "12.5"),
            (3.0, 8, "3.0"),
            (3.0, 1, "3"),
            (std::f64::consts::PI, 5, "3.142"),
            (-std::f64::consts::PI, 5, "-3.14"),
            (1.0e-7, 6, "1e-7"),
            (123_456_789.0, 6, "1.23e8"),
            (0.0, 3, "0.0"),
            (0.0123, 6, "0.0123"),
            (0.0123, 5, ".0123"),
            (0.219_308_635_869_093_13, 15, "0.2193086358691"),
            (-0.0123, 5, "-.012"),
        ] {
            assert_eq!(
                fit(value, width).as_deref(),
                Some(text),
                "{value} in {width}"
            );
        }
        assert_eq!(fit(-1.5e-200, 4), None);
        assert_eq!(fit(f64::NAN, 20), None);
    }

    proptest! {
        #[test]
        fn what_is_written_fits_and_is_near(value in prop::num::f64::NORMAL, width in 3_usize..30) {
            if let Some(text) = fit(value, width) {
                prop_assert!(text.len() <= width);
                let read = crate::number(&text);
                prop_assert!(read.is_some(), "{text}");
                if width >= 24 {
                    prop_assert_eq!(read, Some(value));
                }
            } else {
                prop_assert!(width < 8);
            }
        }
    }
}
