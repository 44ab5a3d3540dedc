//! Quantiles of sorted values.

/// Returns the nearest-rank quantile: the smallest of the sorted values such that at least `percent` percent
/// of them do not exceed it; none if there are no values.
pub fn of<T: Copy>(sorted: &[T], percent: usize) -> Option<T> {
    let rank = (sorted.len() * percent).div_ceil(100).max(1);
    sorted.get(rank - 1).copied()
}

#[cfg(test)]
mod tests {
    use super::of;

    #[test]
    fn a_quantile_is_one_of_the_values_and_so_many_do_not_exceed_it() {
        let sorted: Vec<u32> = (1..=20).collect();
        assert_eq!(
            [0, 5, 50, 95, 96, 100].map(|p| of(&sorted, p)),
            [1, 1, 10, 19, 20, 20].map(Some)
        );
        assert_eq!(of(&[7, 9], 50), Some(7));
        assert_eq!(of::<u32>(&[], 50), None);
    }
}
