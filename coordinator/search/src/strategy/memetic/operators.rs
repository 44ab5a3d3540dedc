//! Genetic operators with their random streams, shared by the generational and the sliding-window form of the
//! algorithm.
//!
//! Every operation has an address, generation and index, so its random numbers do not depend on other
//! operations.
use super::{
    chromosome::{Chromosome, Codec},
    population::Individual,
    roulette::RouletteWheel,
    settings::{MemeticSettings, SpecialCrossover},
    variation,
};
use crate::{
    random::{Phase, Stream, Streams},
    space::{Interval, Space},
    strategy::setting::SettingsError,
};

/// Genetic operators with settings, codec and random streams; constant throughout a run.
pub(super) struct Operators {
    pub(super) settings: MemeticSettings,
    pub(super) codec: Codec,
    streams: Streams,
}

/// Generation and index of a genetic operation, which select its random stream.
#[derive(Clone, Copy, Debug)]
pub(super) struct DrawAddress {
    pub(super) generation: u32,
    pub(super) index: usize,
}

impl Operators {
    /// Creates the genetic operators for the part of a space that `intervals` (coordinate) cover.
    ///
    /// # Errors
    /// If a setting lies outside its range.
    pub(super) fn new(
        settings: MemeticSettings,
        space: &Space,
        intervals: Vec<Interval>,
        streams: Streams,
    ) -> Result<Self, SettingsError> {
        settings.check()?;
        Ok(Self {
            codec: Codec::new(space, intervals, &settings),
            settings,
            streams,
        })
    }

    /// Returns the random stream of an operation.
    pub(super) fn stream(&self, at: DrawAddress, phase: Phase) -> Stream {
        self.streams.at(at.generation, phase, at.index)
    }

    /// Creates member `index` of the initial population: a starting point of the space, or a random
    /// chromosome.
    pub(super) fn first(&self, index: usize) -> Chromosome {
        if let Some(start) = self.codec.start(index) {
            return start;
        }
        let at = DrawAddress {
            generation: 0,
            index,
        };
        self.codec.random(&mut self.stream(at, Phase::Initial))
    }

    pub(super) fn wheel(&self, population: &[Individual]) -> RouletteWheel {
        RouletteWheel::new(population, self.settings.roulette)
    }

    /// Exchanges bits of two parent chromosomes, with the crossover probability.
    pub(super) fn cross(&self, at: DrawAddress, first: &mut Chromosome, second: &mut Chromosome) {
        let mut stream = self.stream(at, Phase::Crossover);
        if stream.chance(self.settings.crossover_probability) {
            variation::cross(
                &self.codec,
                self.settings.crossover,
                (first, second),
                &mut stream,
            );
        }
    }

    /// Mutates a chromosome; `phase` selects the random stream, which differs between children and
    /// hill-climbing trials.
    pub(super) fn mutate(&self, at: DrawAddress, phase: Phase, child: &mut Chromosome) {
        let rule = (
            self.settings.mutation_unit,
            self.settings.mutation_probability,
            self.settings.real_step,
        );
        variation::mutate(&self.codec, child, rule, &mut self.stream(at, phase));
    }

    /// Creates a trial of the first hill climb: the paper's special crossover of the elite with a partner
    /// that is drawn from the trial's random stream. `diversity` is the difference of the population from its
    /// elite [0 to 1].
    pub(super) fn crossover_trial<'a>(
        &self,
        at: DrawAddress,
        start: &Chromosome,
        diversity: f64,
        partner: impl FnOnce(&mut Stream) -> &'a Chromosome,
    ) -> Chromosome {
        let mut stream = self.stream(at, Phase::CrossoverTrial);
        let partner = partner(&mut stream);
        let share = match self.settings.special_crossover {
            SpecialCrossover::EliteBiased => (0.1 + 0.5 * diversity).clamp(0.1, 0.6),
            SpecialCrossover::Even => 0.5,
        };
        variation::elite_crossover(&self.codec, start, partner, share, &mut stream)
    }

    /// Creates a trial of the second hill climb: the elite with a few random bits flipped.
    pub(super) fn mutation_trial(
        &self,
        at: DrawAddress,
        start: &Chromosome,
        diversity: f64,
    ) -> Chromosome {
        let mut stream = self.stream(at, Phase::MutationTrial);
        let count = self.settings.flipped_bits;
        let count = count.unwrap_or_else(|| adaptive_bits(diversity));
        let how = (count, self.settings.real_step);
        variation::flip_some(&self.codec, start, how, &mut stream)
    }
}

/// Returns the number of bits that a mutation trial flips: 1 to 4, more in a more diverse population.
fn adaptive_bits(diversity: f64) -> usize {
    match 3.0 * diversity {
        x if x < 0.5 => 1,
        x if x < 1.5 => 2,
        x if x < 2.5 => 3,
        _ => 4,
    }
}
