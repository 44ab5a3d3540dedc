//! The operators with the streams that they draw from: one breeding for both forms of the algorithm.
//!
//! Every operation has an address, generation and index, so that none sees what another has drawn.
use super::{
    chromosome::{Chromosome, Codec},
    population::Individual,
    settings::{MemeticSettings, SpecialCrossover},
    variation,
    wheel::Wheel,
};
use crate::{
    random::{Phase, Stream, Streams},
    space::{Interval, Space},
    strategy::setting::SettingsError,
};

/// What individuals are made with; the same all through a run.
pub(super) struct Craft {
    pub(super) settings: MemeticSettings,
    pub(super) codec: Codec,
    streams: Streams,
}

/// The address of an operation.
#[derive(Clone, Copy, Debug)]
pub(super) struct At {
    pub(super) generation: u32,
    pub(super) index: usize,
}

impl Craft {
    /// For the part of a space that `intervals` (coordinate) cover.
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

    /// The stream of an operation.
    pub(super) fn stream(&self, at: At, phase: Phase) -> Stream {
        self.streams.at(at.generation, phase, at.index)
    }

    /// An individual of the first population: a start of the space, or a random one.
    pub(super) fn first(&self, index: usize) -> Chromosome {
        if let Some(start) = self.codec.start(index) {
            return start;
        }
        let at = At {
            generation: 0,
            index,
        };
        self.codec.random(&mut self.stream(at, Phase::Initial))
    }

    /// The wheel of a population.
    pub(super) fn wheel(&self, population: &[Individual]) -> Wheel {
        Wheel::new(population, self.settings.roulette)
    }

    /// Exchanges parts of two chromosomes, or does not, by chance.
    pub(super) fn cross(&self, at: At, first: &mut Chromosome, second: &mut Chromosome) {
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

    /// Mutates a chromosome; `phase` tells children from trials.
    pub(super) fn mutate(&self, at: At, phase: Phase, child: &mut Chromosome) {
        let rule = (
            self.settings.mutation_unit,
            self.settings.mutation_probability,
            self.settings.real_step,
        );
        variation::mutate(&self.codec, child, rule, &mut self.stream(at, phase));
    }

    /// A trial of the first hill climb: the special crossover with a partner, which draws from the
    /// trial's stream. `diversity` says how much the population differs from its elite [0 to 1].
    pub(super) fn crossover_trial<'a>(
        &self,
        at: At,
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

    /// A trial of the second hill climb: a few random bits flipped.
    pub(super) fn mutation_trial(&self, at: At, start: &Chromosome, diversity: f64) -> Chromosome {
        let mut stream = self.stream(at, Phase::MutationTrial);
        let count = self.settings.flipped_bits;
        let count = count.unwrap_or_else(|| adaptive_bits(diversity));
        let how = (count, self.settings.real_step);
        variation::flip_some(&self.codec, start, how, &mut stream)
    }
}

/// 1 to 4 bits, more in a diverse population.
fn adaptive_bits(diversity: f64) -> usize {
    match 3.0 * diversity {
        x if x < 0.5 => 1,
        x if x < 1.5 => 2,
        x if x < 2.5 => 3,
        _ => 4,
    }
}
