//! Statistics of repeated measurements of one value.

/// Returns mean (`None` without values), standard deviation (n - 1; 0 for fewer than two values) and number
/// of the values.
pub fn mean_and_spread(values: impl Iterator<Item = f64> + Clone) -> (Option<f64>, f64, usize) {
    let count = values.clone().count();
    if count == 0 {
        return (None, 0.0, 0);
    }
    let mean = values.clone().sum::<f64>() / count as f64;
    let squares: f64 = values.map(|value| (value - mean) * (value - mean)).sum();
    let spread = if count > 1 {
        (squares / (count - 1) as f64).sqrt()
    } else {
        0.0
    };
    (Some(mean), spread, count)
}
