//! Numbers of statistics, as sentences and tables have them.
use crate::number::{NONE, figure, fixed, quantity};

/// A p-value; below what its law can promise, only that.
pub(in crate::diagnosis) fn p_value(p: f64) -> String {
    if p.is_finite() && p < 1e-12 {
        "< 10⁻¹²".to_owned()
    } else {
        figure(p)
    }
}

/// The same behind a symbol: `= x`, or `< x` as it is.
pub(in crate::diagnosis) fn equals(p: &str) -> String {
    if p.starts_with('<') {
        p.to_owned()
    } else {
        format!("= {p}")
    }
}

/// Nats with one decimal, a whole number where they are many.
pub(in crate::diagnosis) fn nats(value: f64) -> String {
    fixed(value, usize::from(value.abs() < 999.5))
}

/// An interval with its unit once.
pub(in crate::diagnosis) fn interval([low, high]: [f64; 2], unit: &str) -> String {
    if low.is_finite() && high.is_finite() {
        format!("{} to {}", figure(low), quantity(high, unit))
    } else {
        NONE.to_owned()
    }
}
