//! Confidence intervals of proportions.
use statrs::distribution::{Beta, ContinuousCDF};

/// Computes the Clopper-Pearson 95 % interval of a proportion from `hits` of `trials`; the whole unit
/// interval without trials.
pub fn clopper_pearson(hits: usize, trials: usize) -> [f64; 2] {
    const TAIL: f64 = 0.025;
    let (k, n) = (hits as f64, trials as f64);
    let quantile = |a: f64, b: f64, p: f64, edge: f64| {
        Beta::new(a, b).map_or(edge, |beta| beta.inverse_cdf(p))
    };
    let lower = if hits == 0 {
        0.0
    } else {
        quantile(k, n - k + 1.0, TAIL, 0.0)
    };
    let upper = if hits >= trials {
        1.0
    } else {
        quantile(k + 1.0, n - k, 1.0 - TAIL, 1.0)
    };
    [lower, upper]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the intervals against published tables and against their definition by binomial tails.
    #[test]
    fn intervals_are_those_of_the_binomial() {
        let [lower, upper] = clopper_pearson(0, 60);
        assert!(
            lower.abs() < 1e-12 && (upper - 0.0596).abs() < 1e-3,
            "{upper}"
        );
        let [lower, upper] = clopper_pearson(9, 10);
        assert!((lower - 0.5550).abs() < 1e-3 && (upper - 0.9975).abs() < 1e-3);
        assert_eq!(
            clopper_pearson(0, 0).map(f64::to_bits),
            [0.0, 1.0].map(f64::to_bits)
        );
        let tail = |p: f64, from: i32| -> f64 {
            let choose = |k: i32| {
                (1..=k)
                    .map(|i| f64::from(21 - i) / f64::from(i))
                    .product::<f64>()
            };
            (from..=20)
                .map(|k| choose(k) * p.powi(k) * (1.0 - p).powi(20 - k))
                .sum()
        };
        let [lower, upper] = clopper_pearson(13, 20);
        assert!((tail(lower, 13) - 0.025).abs() < 1e-6);
        assert!((1.0 - tail(upper, 14) - 0.025).abs() < 1e-6);
    }
}
