//! Random number streams by purpose: draws for one purpose never change those for another.
use libm::{cos, exp, log, sqrt};
use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};
use std::f64::consts::TAU;

/// Random number stream for one purpose.
#[derive(Clone, Debug)]
pub struct RandomStream(ChaCha8Rng);

impl RandomStream {
    /// Creates the random number stream for a seed and a purpose.
    pub fn new(seed: u64, purpose: &str) -> Self {
        let mut hasher = blake3::Hasher::new_derive_key("horsehead blind suite draws");
        hasher.update(&seed.to_le_bytes());
        hasher.update(purpose.as_bytes());
        Self(ChaCha8Rng::from_seed(*hasher.finalize().as_bytes()))
    }

    /// Draws a uniform number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Draws a uniform number between two bounds.
    pub fn between(&mut self, lower: f64, upper: f64) -> f64 {
        lower + (upper - lower) * self.unit()
    }

    /// Draws a log-uniform number between two positive bounds.
    pub fn log_between(&mut self, lower: f64, upper: f64) -> f64 {
        exp(self.between(log(lower), log(upper)))
    }

    /// Draws a standard normal number.
    pub fn normal(&mut self) -> f64 {
        let radius = sqrt(-2.0 * log(1.0 - self.unit()));
        radius * cos(TAU * self.unit())
    }

    /// Draws a standard normal number, clamped to two standard deviations.
    pub fn clamped_normal(&mut self) -> f64 {
        self.normal().clamp(-2.0, 2.0)
    }

    /// Draws a sign, -1 or 1.
    pub fn sign(&mut self) -> f64 {
        if self.unit() < 0.5 { -1.0 } else { 1.0 }
    }

    /// Draws an index into a list of `len` entries; 0 for an empty list.
    pub fn index(&mut self, len: usize) -> usize {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "below `len` and not negative"
        )]
        let place = (self.unit() * len as f64) as usize;
        place.min(len.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn purposes_do_not_share_numbers_and_moments_are_those_of_the_laws() {
        let draws = |purpose: &str| -> Vec<f64> {
            let mut draw = RandomStream::new(7, purpose);
            (0..20_000).map(|_| draw.normal()).collect()
        };
        let (a, b) = (draws("noise"), draws("genes"));
        let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
        let product: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a * b).collect();
        let square: Vec<f64> = a.iter().map(|a| a * a).collect();
        assert!(mean(&a).abs() < 0.03 && mean(&product).abs() < 0.03);
        assert!((mean(&square) - 1.0).abs() < 0.04);
        assert_eq!(a, draws("noise"));
        let mut draw = RandomStream::new(7, "size");
        let sizes: Vec<f64> = (0..2_000).map(|_| draw.log_between(0.5, 8.0)).collect();
        let below = sizes.iter().filter(|size| **size < 2.0).count();
        assert!(sizes.iter().all(|size| (0.5..8.0).contains(size)));
        assert!((900..1100).contains(&below), "half of the decades: {below}");
    }
}
