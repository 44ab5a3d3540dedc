//! Keyed random numbers: every draw has an address (its key), and no generator is shared.
//!
//! A stream is `ChaCha8` with the key (run seed, scope, generation, phase, index). Draws with different
//! addresses are independent of each other and of earlier draws, so evaluating trials ahead of time or out of
//! order cannot change a single bit. Conversions to reals and indices are written here, because those of
//! libraries may change between versions.
use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};

/// Purpose of a random draw; part of the key that addresses the draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Draws of the initial population or design of the search.
    Initial,
    /// Roulette draws of a generation.
    Selection,
    /// Draws of the crossover of a pair of parents.
    Crossover,
    /// Draws of the mutation of a child.
    Mutation,
    /// Draws of one crossover-based hill-climbing trial.
    CrossoverTrial,
    /// Draws of one mutation-based hill-climbing trial.
    MutationTrial,
    /// Draws of one step of a local refinement.
    Refinement,
    /// Draws of noise, or of a resample of cycles, for the reference distribution of a test statistic.
    Resample,
}

/// Factory of the random streams of one part of a run.
#[derive(Clone, Copy, Debug)]
pub struct Streams {
    seed: u64,
    scope: u32,
}

impl Streams {
    /// Creates the streams of a run; `scope` distinguishes the parts of a composed strategy.
    pub const fn new(seed: u64, scope: u32) -> Self {
        Self { seed, scope }
    }

    /// Returns the random stream addressed by a generation, the purpose of the draws and an index.
    pub fn at(&self, generation: u32, phase: Phase, index: usize) -> Stream {
        let mut key = [0_u8; 32];
        let address = self
            .seed
            .to_le_bytes()
            .into_iter()
            .chain(self.scope.to_le_bytes())
            .chain(generation.to_le_bytes())
            .chain((phase as u32).to_le_bytes())
            .chain((index as u64).to_le_bytes());
        for (slot, byte) in key.iter_mut().zip(address) {
            *slot = byte;
        }
        Stream(ChaCha8Rng::from_seed(key))
    }
}

/// Random number stream for one address (seed, scope, generation, phase, index).
#[derive(Clone, Debug)]
pub struct Stream(ChaCha8Rng);

impl Stream {
    /// Draws a uniform number in [0, 1), a multiple of 2^-53.
    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns true with probability `p`; always draws.
    pub fn chance(&mut self, p: f64) -> bool {
        self.unit() < p
    }

    /// Draws a uniform index in 0..`len`, or 0 for an empty range; the bias is below `len` / 2^64.
    pub fn index(&mut self, len: usize) -> usize {
        let wide = (u128::from(self.0.next_u64()) * len as u128) >> 64;
        usize::try_from(wide).unwrap_or(0)
    }

    /// Draws 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Draws a standard normal number by the Box-Muller transform.
    pub fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.unit()));
        radius * libm::cos(std::f64::consts::TAU * self.unit())
    }

    /// Shuffles items into random order (Fisher-Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.index(last + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_the_address_changes_the_stream() {
        let base = Streams::new(7, 0).at(3, Phase::Mutation, 11).bits();
        assert_eq!(base, Streams::new(7, 0).at(3, Phase::Mutation, 11).bits());
        for other in [
            Streams::new(8, 0).at(3, Phase::Mutation, 11),
            Streams::new(7, 1).at(3, Phase::Mutation, 11),
            Streams::new(7, 0).at(4, Phase::Mutation, 11),
            Streams::new(7, 0).at(3, Phase::Crossover, 11),
            Streams::new(7, 0).at(3, Phase::Mutation, 12),
        ] {
            let mut other = other;
            assert_ne!(base, other.bits());
        }
    }

    #[test]
    fn uniform_and_normal_numbers_have_their_moments() {
        let mut stream = Streams::new(1, 0).at(0, Phase::Initial, 0);
        let n = 20_000;
        let (mut sum, mut square, mut uniform) = (0.0, 0.0, 0.0);
        let mut seen = [0_u32; 5];
        for _ in 0..n {
            let z = stream.normal();
            sum += z;
            square += z * z;
            uniform += stream.unit();
            seen[stream.index(5)] += 1;
        }
        let n = f64::from(n);
        assert!((sum / n).abs() < 0.03);
        assert!((square / n - 1.0).abs() < 0.05);
        assert!((uniform / n - 0.5).abs() < 0.01);
        for count in seen {
            assert!((f64::from(count) / n - 0.2).abs() < 0.02);
        }
    }

    #[test]
    fn a_shuffle_is_a_permutation() {
        let mut items: Vec<usize> = (0..50).collect();
        Streams::new(2, 0)
            .at(0, Phase::Initial, 0)
            .shuffle(&mut items);
        assert_ne!(items, (0..50).collect::<Vec<_>>());
        items.sort_unstable();
        assert_eq!(items, (0..50).collect::<Vec<_>>());
    }
}
