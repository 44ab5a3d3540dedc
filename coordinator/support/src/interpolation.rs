//! Piecewise linear interpolation in tables.

/// Interpolates in a table with ascending abscissas; returns none outside the table or beside a value that is
/// not finite.
pub fn interpolated(xs: &[f64], ys: &[f64], x: f64) -> Option<f64> {
    let above = xs.partition_point(|&known| known < x);
    let right = (*xs.get(above)?, *ys.get(above)?);
    if (right.0 - x).abs() < 1e-9 {
        return right.1.is_finite().then_some(right.1);
    }
    let below = above.checked_sub(1)?;
    between((*xs.get(below)?, *ys.get(below)?), right, x)
}

/// Interpolates linearly in a table; outside it returns the value of the nearest end, and 0 for an empty
/// table.
pub fn interpolate_clamped(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let end = match xs.first() {
        Some(first) if x < *first => ys.first(),
        Some(_) | None => ys.last(),
    };
    let end = || end.copied().unwrap_or_default();
    interpolated(xs, ys, x).unwrap_or_else(end)
}

/// Interpolates in a table whose abscissas lie within one period from 0 and do not repeat the first point.
pub fn periodic(xs: &[f64], ys: &[f64], x: f64, period: f64) -> Option<f64> {
    let place = x.rem_euclid(period);
    interpolated(xs, ys, place).or_else(|| {
        let (last, first) = ((*xs.last()?, *ys.last()?), (*xs.first()?, *ys.first()?));
        if place < first.0 {
            between((last.0 - period, last.1), first, place)
        } else {
            between(last, (first.0 + period, first.1), place)
        }
    })
}

/// Interpolates linearly between two points; none if the result is not finite.
fn between((x0, y0): (f64, f64), (x1, y1): (f64, f64), x: f64) -> Option<f64> {
    let y = y0 + (y1 - y0) * (x - x0) / (x1 - x0);
    y.is_finite().then_some(y)
}

#[cfg(test)]
mod tests {
    use super::{interpolate_clamped, interpolated, periodic};

    #[test]
    fn a_table_is_not_continued_unless_it_is_held_or_repeats() {
        let (xs, ys) = ([0.0, 1.0, 3.0], [10.0, 20.0, 40.0]);
        assert_eq!(interpolated(&xs, &ys, 2.0), Some(30.0));
        assert_eq!(interpolated(&xs, &ys, 0.0), Some(10.0));
        assert_eq!(interpolated(&xs, &ys, 3.1), None);
        assert_eq!(interpolated(&xs, &ys, -0.1), None);
        assert_eq!(interpolated(&[], &[], 0.0), None);
        for (x, y) in [(-1.0, 10.0), (2.0, 30.0), (9.0, 40.0)] {
            assert!((interpolate_clamped(&xs, &ys, x) - y).abs() < 1e-12, "{x}");
        }
        assert!(interpolate_clamped(&[], &[], 1.0).abs() < 1e-300);
        assert_eq!(periodic(&xs, &ys, 3.5, 4.0), Some(25.0));
        assert_eq!(periodic(&xs, &ys, -2.0, 4.0), Some(30.0));
        // the first point later than 0
        assert_eq!(periodic(&[1.0, 3.0], &[20.0, 40.0], 0.0, 4.0), Some(30.0));
        assert_eq!(periodic(&[1.0, 3.0], &[20.0, 40.0], 3.5, 4.0), Some(35.0));
        assert_eq!(periodic(&[], &[], 1.0, 4.0), None);
    }
}
