//! Formatting of statistical numbers for sentences and tables.
use crate::number::{MISSING, fixed, significant};

/// Formats a p-value; values below 10⁻¹² are given as a bound, since their distribution is not accurate
/// there.
pub(in crate::diagnosis) fn p_value(p: f64) -> String {
    if p.is_finite() && p < 1e-12 {
        "< 10⁻¹²".to_owned()
    } else {
        significant(p)
    }
}

/// Prefixes a formatted p-value with `= `, unless it already starts with `<`.
pub(in crate::diagnosis) fn equals(p: &str) -> String {
    if p.starts_with('<') {
        p.to_owned()
    } else {
        format!("= {p}")
    }
}

/// Formats a value in nats with one decimal, without decimals from 1000 on.
pub(in crate::diagnosis) fn nats(value: f64) -> String {
    fixed(value, usize::from(value.abs() < 999.5))
}

/// Formats evidence in nats as odds, up to a million to one.
pub(in crate::diagnosis) fn odds(value: f64) -> String {
    /// Odds beyond which a number says nothing more.
    const MOST: f64 = 1e6;
    let odds = libm::exp(value.abs());
    if value.is_nan() {
        MISSING.to_owned()
    } else if odds > MOST {
        "practically certain".to_owned()
    } else {
        format!("odds of {} to 1", significant(odds))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evidence_is_told_as_odds_up_to_a_million() {
        assert_eq!(odds(3.0), "odds of 20.1 to 1");
        assert_eq!(odds(14.0), "practically certain");
        assert_eq!(odds(f64::INFINITY), "practically certain");
        assert_eq!(odds(f64::NAN), MISSING);
    }
}
