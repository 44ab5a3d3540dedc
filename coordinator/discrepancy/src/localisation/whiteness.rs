//! Test of whether a residual is white: whether its power is spread evenly over the orders of a period, or
//! over the waves (Fourier coefficients) of a sequence of samples.
//!
//! Powers of a whitened residual, each over its mean under noise, are summed from the lowest wave on. For
//! noise the cumulated share grows evenly; its largest distance from a straight line follows Kolmogorov's
//! distribution (Bartlett's test of the cumulated periodogram; Priestley, *Spectral Analysis and Time
//! Series*, 6.2.5). The test is independent of the noise level: noise that is underestimated at every wave
//! alike passes here and shows in the misfit.
/// Returns the p-value of the whiteness test from powers over their means under noise, by channel. `freedom`
/// is the number of degrees of freedom of the noise variances. Returns 1 for fewer than two entries.
pub fn p_value(ratio: &[Vec<f64>], freedom: f64) -> f64 {
    let highest = ratio.iter().map(Vec::len).max().unwrap_or(0);
    let at = |k: usize| ratio.iter().filter_map(move |row| row.get(k));
    let powers: Vec<f64> = (0..highest).flat_map(at).copied().collect();
    let (count, sum) = (powers.len() as f64, powers.iter().sum::<f64>());
    if powers.len() < 2 || !(sum > 0.0 && sum.is_finite()) {
        return 1.0;
    }
    let mut share = 0.0;
    let mut distance = 0.0_f64;
    for (k, power) in (1_u32..).zip(&powers) {
        share += power / sum;
        distance = distance.max((share - f64::from(k) / count).abs());
    }
    // a power is F(2, 2 nu), which scatters more than the exponential that it is for known variances
    let scatter = (freedom / (freedom - 2.0).max(0.5)).sqrt().max(1.0);
    let root = count.sqrt();
    kolmogorov((root + 0.12 + 0.11 / root) * distance / scatter)
}

/// Returns the upper tail of Kolmogorov's distribution.
fn kolmogorov(x: f64) -> f64 {
    if x < 0.2 {
        // one to twelve digits, where the series no longer falls
        return 1.0;
    }
    let term = |j: f64| libm::exp(-2.0 * j * j * x * x);
    let pairs = (0..50).map(|k| term(f64::from(2 * k + 1)) - term(f64::from(2 * k + 2)));
    (2.0 * pairs.sum::<f64>()).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use search::random::{Phase, Streams};

    /// Draws noise powers of two channels over fifty orders, divided by variances estimated from `freedom`
    /// draws (0: known exactly).
    fn noise(seed: u64, freedom: usize) -> Vec<Vec<f64>> {
        let mut stream = Streams::new(seed, 3).at(0, Phase::Initial, 0);
        let mut square = |count: usize| (0..count).map(|_| stream.normal().powi(2)).sum::<f64>();
        let mut power = || {
            let mean = square(2) / 2.0;
            if freedom == 0 {
                mean
            } else {
                mean / (square(2 * freedom) / (2 * freedom) as f64)
            }
        };
        vec![
            (0..50).map(|_| power()).collect(),
            (0..50).map(|_| power()).collect(),
        ]
    }

    /// Checks Kolmogorov's distribution at its usual quantiles.
    #[test]
    fn kolmogorovs_points() {
        for (x, p) in [(1.2238, 0.10), (1.3581, 0.05), (1.6276, 0.01)] {
            assert!((kolmogorov(x) - p).abs() < 1e-4, "{x}");
        }
        assert!((kolmogorov(0.2) - 1.0).abs() < 1e-9);
    }

    /// Checks that about one noise map in twenty has a p-value below 5 %, whether its variances are known or
    /// estimated.
    #[test]
    fn noise_is_white_as_often_as_it_should() {
        for freedom in [0, 12] {
            let sets = 1000;
            let known = if freedom == 0 { 1e9 } else { freedom as f64 };
            let below = (0..sets)
                .filter(|seed| p_value(&noise(*seed, freedom), known) < 0.05)
                .count();
            assert!((20..=80).contains(&below), "{below} of {sets}, {freedom}");
        }
    }

    /// Checks that a residual with more power at low orders is not white, and that a common factor of all
    /// powers changes nothing.
    #[test]
    fn what_is_left_at_low_orders_is_not_white() {
        let mut map = noise(4, 12);
        let white = p_value(&map, 12.0);
        map.iter_mut().flatten().for_each(|power| *power *= 3.0);
        assert!((p_value(&map, 12.0) - white).abs() < 1e-9);
        for row in &mut map {
            row[..10].iter_mut().for_each(|power| *power *= 3.0);
        }
        assert!(p_value(&map, 12.0) < 1e-3);
        map.clear();
        assert_eq!(p_value(&map, 12.0).to_bits(), 1.0_f64.to_bits());
    }
}
