//! Pairing and thinning of points before drawing.

/// Returns at most `most` of the values, evenly selected, including the first and the last.
pub fn thinned<T: Copy>(values: &[T], most: usize) -> Vec<T> {
    if values.len() <= most || most < 2 {
        return values.to_vec();
    }
    (0..most)
        .map(|index| values[index * (values.len() - 1) / (most - 1)])
        .collect()
}

/// Pairs abscissas and values; the result is as long as the shorter list.
pub fn points(xs: &[f64], ys: &[f64]) -> Vec<(f64, f64)> {
    xs.iter().copied().zip(ys.iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::thinned;

    #[test]
    fn thinning_keeps_the_ends() {
        let values: Vec<u32> = (0..1000).collect();
        let few = thinned(&values, 37);
        assert_eq!((few.len(), few[0], few[36]), (37, 0, 999));
        assert_eq!(thinned(&values[..5], 37), [0, 1, 2, 3, 4]);
    }
}
