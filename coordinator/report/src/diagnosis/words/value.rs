//! Formatting of statistical numbers for sentences and tables.
use crate::number::{MISSING, fixed, quantity, significant};

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

/// Formats an interval, with its unit written once.
pub(in crate::diagnosis) fn interval([low, high]: [f64; 2], unit: &str) -> String {
    if low.is_finite() && high.is_finite() {
        format!("{} to {}", significant(low), quantity(high, unit))
    } else {
        MISSING.to_owned()
    }
}
