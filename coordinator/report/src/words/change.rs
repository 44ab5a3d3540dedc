//! Sentences about the change of a value.
use crate::number::{percent, significant};

/// Describes the change of a value, as "fell from 6.8 to 0.75 (−89 %)".
pub(crate) fn change(from: f64, to: f64, suffix: &str) -> String {
    let verb = if to < from {
        "fell"
    } else if to > from {
        "rose"
    } else {
        return format!("stayed at {}{suffix}", significant(from));
    };
    let share = to / from - 1.0;
    let share = if !share.is_finite() || from <= 0.0 {
        String::new()
    } else if share < 9.0 {
        let sign = if share > 0.0 { "+" } else { "" };
        format!(" ({sign}{})", percent(share))
    } else {
        format!(" ({} times)", significant(to / from))
    };
    format!(
        "{verb} from {} to {}{suffix}{share}",
        significant(from),
        significant(to)
    )
}

#[cfg(test)]
mod tests {
    use super::change;

    #[test]
    fn changes_are_said_with_their_direction() {
        assert_eq!(
            change(6.8, 0.75, " mm²"),
            "fell from 6.80 to 0.750 mm² (−89.0\u{a0}%)"
        );
        assert_eq!(
            change(1.0, 1.5, ""),
            "rose from 1.00 to 1.50 (+50.0\u{a0}%)"
        );
        assert_eq!(change(1.0, 40.0, ""), "rose from 1.00 to 40.0 (40.0 times)");
        assert_eq!(change(2.0, 2.0, ""), "stayed at 2.00");
    }
}
