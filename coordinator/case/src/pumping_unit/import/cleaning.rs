//! Checks of a raw signal: constant, saturated, and outliers.
use super::logger::Table;
use crate::error::CaseError;

/// Deviation of a sample from the median of five neighbours, relative to the one that nine of ten samples stay
/// below, from which on it counts as an outlier. The largest of Gaussian noise in a million samples is 4, of
/// noise that rounding hides at times 8; a real shock lasts longer than two samples, which the median follows.
const OUTLIER: f64 = 12.0;

/// Smallest deviation of an outlier, relative to the range of the signal: the peaks of a smooth signal
/// of 30 samples a turn deviate by 1 %.
const LEAST: f64 = 0.03;

/// Number of samples at the largest or smallest value, relative to those just below it, from which on a
/// signal counts as saturated. At the top of a parabola the ratio is 2.4, of a flat quartic 5.3.
const SATURATED: f64 = 8.0;

/// Smallest number of samples at the largest or smallest value of a saturated signal.
const FEWEST: usize = 8;

/// Smallest difference between values of a signal: its resolution; `None` where all are equal.
pub(super) fn resolution(values: &[f64]) -> Option<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| !v.is_nan()).collect();
    sorted.sort_by(f64::total_cmp);
    let range = sorted.last()? - sorted.first()?;
    let steps = sorted.windows(2).map(|pair| pair[1] - pair[0]);
    // differences that rounding leaves between equal values are none
    steps
        .filter(|step| *step > 1e-9 * range)
        .min_by(f64::total_cmp)
}

/// Replaces outliers by NaN and returns their number.
pub(super) fn remove_outliers(values: &mut [f64]) -> usize {
    let known: Vec<usize> = (0..values.len())
        .filter(|row| !values[*row].is_nan())
        .collect();
    let deviations: Vec<f64> = known
        .windows(5)
        .map(|five| {
            let mut near = [0, 1, 2, 3, 4].map(|place| values[five[place]]);
            near.sort_by(f64::total_cmp);
            values[five[2]] - near[2]
        })
        .collect();
    let mut sizes: Vec<f64> = deviations.iter().map(|one| one.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let usual = sizes.get(sizes.len() * 9 / 10).copied().unwrap_or_default();
    let mut sorted: Vec<f64> = known.iter().map(|row| values[*row]).collect();
    sorted.sort_by(f64::total_cmp);
    // without the outliers themselves
    let end = sorted.len() / 100;
    let ends = sorted.get(end).zip(sorted.iter().rev().nth(end));
    let range = ends.map_or(0.0, |(low, high)| high - low);
    let step = resolution(values).unwrap_or_default();
    let limit = (OUTLIER * usual).max(3.0 * step).max(LEAST * range);
    let mut removed = 0;
    for (five, deviation) in known.windows(5).zip(deviations) {
        if deviation.abs() > limit {
            values[five[2]] = f64::NAN;
            removed += 1;
        }
    }
    removed
}

/// Checks that a signal varies and is not saturated.
///
/// # Errors
/// Returns an error with the column and the first line at which the signal rests at its limit.
pub(super) fn check(table: &Table, column: &str, values: &[f64]) -> Result<(), CaseError> {
    let known = values.iter().copied().filter(|value| !value.is_nan());
    let lowest = known.clone().fold(f64::INFINITY, f64::min);
    let highest = known.clone().fold(f64::NEG_INFINITY, f64::max);
    let fault = |row: usize, value: String, help: &str| {
        const ALLOWED: &str = "a signal that varies within the range of its amplifier";
        table.fault(row, column, value, ALLOWED, help)
    };
    if lowest >= highest {
        return Err(fault(
            0,
            if lowest.is_finite() {
                format!("{lowest} in every row")
            } else {
                "no value in any row".to_owned()
            },
            "the sensor is dead or not connected: remove the column from `curves` in the mapping",
        ));
    }
    let step = resolution(values).unwrap_or_default();
    let width = (1.5 * step).max((highest - lowest) / 200.0);
    for (limit, sign) in [(highest, 1.0), (lowest, -1.0)] {
        let below = |value: f64| sign * (limit - value);
        let at = known
            .clone()
            .filter(|value| below(*value) < 0.5 * step)
            .count();
        let near = known
            .clone()
            .filter(|value| (0.5 * step..=width).contains(&below(*value)))
            .count();
        if at >= FEWEST && at as f64 > SATURATED * (near as f64).max(1.0) {
            let row = values.iter().position(|value| below(*value) < 0.5 * step);
            return Err(fault(
                row.unwrap_or_default(),
                format!("{limit}, as in {at} of {} rows,", table.lines.len()),
                "the signal is cut off at the limit of its amplifier: measure again with a wider range, or \
                 remove the column from `curves` in the mapping",
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn table(rows: u32) -> Table {
        Table {
            files: vec![(0, "raw.csv".into())],
            time_s: (0..rows).map(f64::from).collect(),
            columns: Vec::new(),
            lines: (2..rows + 2).collect(),
            words: Vec::new(),
            short: 0,
        }
    }

    fn signal(shape: impl Fn(f64) -> f64, step: f64) -> Vec<f64> {
        let value = |row: u32| shape(TAU * f64::from(row) / 1200.0);
        (0..6000)
            .map(|row| (value(row) / step).round() * step)
            .collect()
    }

    /// Checks that a signal which rests at a limit is refused, and that the flat tops of clean, coarsely
    /// resolved curves are not.
    #[test]
    fn a_saturated_signal_is_told_from_a_flat_top() {
        let table = table(6000);
        for step in [1e-9, 0.01, 0.2, 1.0] {
            let clean = signal(|angle| 20.0 * angle.sin(), step);
            assert!(check(&table, "a", &clean).is_ok(), "{step}");
            let flat = signal(|angle| 20.0 * (1.0 - (0.5 * angle).sin().powi(4)), step);
            assert!(check(&table, "a", &flat).is_ok(), "{step}");
            let cut = signal(|angle| (20.0 * angle.sin()).min(15.0), step);
            let error = check(&table, "a", &cut).unwrap_err().to_string();
            assert!(error.contains("limit of its amplifier"), "{step}: {error}");
            let cut = signal(|angle| (20.0 * angle.sin()).max(-15.0), step);
            assert!(check(&table, "a", &cut).is_err(), "{step}");
        }
        let error = check(&table, "a", &vec![3.0; 6000])
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("row 2, column `a`: 3 in every row"),
            "{error}"
        );
    }

    /// Checks that spikes of one or two samples are removed, and nothing of a clean or noisy curve.
    #[test]
    fn outliers_are_removed() {
        for step in [1e-6, 0.2] {
            let noise = |row: usize| 0.3 * (((row * 7919) % 101) as f64 / 50.0 - 1.0);
            let mut values: Vec<f64> = signal(|angle| 20.0 * angle.sin(), 1e-9)
                .iter()
                .enumerate()
                .map(|(row, value)| ((value + noise(row)) / step).round() * step)
                .collect();
            assert_eq!(remove_outliers(&mut values.clone()), 0);
            let mut smooth = signal(|angle| 20.0 * (40.0 * angle).sin(), 1e-6);
            assert_eq!(remove_outliers(&mut smooth), 0);
            values[100] += 50.0;
            values[2000] -= 90.0;
            values[2001] -= 90.0;
            assert_eq!(remove_outliers(&mut values), 3);
            assert!(values[100].is_nan() && values[2001].is_nan());
        }
    }
}
