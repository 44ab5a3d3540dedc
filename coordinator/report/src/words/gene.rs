//! Descriptions of an unknown's bounds and interval.
use crate::number::{interval, quantity};
use discrepancy::identify::UnknownEstimate;
use protocol::case::{Scale, Unknown};

/// Describes a bound of an unknown, as "its upper bound 1.00e12 N/m".
pub(crate) fn bound(gene: &Unknown, side: &str) -> String {
    let value = if side == "lower" {
        gene.lower
    } else {
        gene.upper
    };
    format!("its {side} bound {}", quantity(value, &gene.unit))
}

/// Returns the description of the bound at which an unknown's value lies, within half a per cent of the
/// interval on the unknown's scale; `None` if at neither.
pub(crate) fn at_bound(gene: &Unknown, value: f64) -> Option<&'static str> {
    let Unknown { lower, upper, .. } = *gene;
    let share = match gene.scale {
        Scale::Logarithmic => (value / lower).ln() / (upper / lower).ln(),
        Scale::Linear => (value - lower) / (upper - lower),
    };
    if share < 0.005 {
        Some("lower")
    } else if share > 0.995 {
        Some("upper")
    } else {
        None
    }
}

/// Formats the interval that the measured record determines for an unknown, as a table cell.
pub(crate) fn interval_cell(own: &UnknownEstimate) -> String {
    let of = |x: f64| quantity(x, &own.unit);
    match own.interval {
        [Some(low), Some(high)] => interval([low, high], &own.unit),
        [Some(low), None] => format!("at least {}", of(low)),
        [None, Some(high)] => format!("at most {}", of(high)),
        [None, None] => "not determined by this record".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{at_bound, bound};
    use protocol::case::{Scale, Unknown};

    #[test]
    fn bounds_are_noticed_on_the_scale_of_the_unknown() {
        let stiffness = Unknown::new("k", "N/m", Scale::Logarithmic, 1e8, [1e4, 1e12]);
        assert_eq!(at_bound(&stiffness, 1e4), Some("lower"));
        assert_eq!(at_bound(&stiffness, 0.99e12), Some("upper"));
        assert_eq!(at_bound(&stiffness, 2e4), None);
        let size = Unknown::new("size", "N", Scale::Linear, 0.0, [-500.0, 1500.0]);
        assert_eq!(at_bound(&size, -499.0), Some("lower"));
        assert_eq!(at_bound(&size, 0.0), None);
        assert_eq!(at_bound(&size, 1400.0), None);
        assert_eq!(bound(&size, "upper"), "its upper bound 1500\u{a0}N");
    }
}
