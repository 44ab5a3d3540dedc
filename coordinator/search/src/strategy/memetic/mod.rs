//! The memetic algorithm of the reference paper (sections 5.1 to 5.3): a genetic algorithm on bit
//! strings whose elite climbs hills after every generation.
//!
//! One generation: parents by roulette, uniform crossover, bit mutation, one elite kept; then the
//! elite tries crossovers with partners, and flips of a few random bits, and moves wherever it
//! gets better. What the paper leaves open is a documented choice in [`MemeticSettings`].
mod chromosome;
mod climb;
mod selection;
mod settings;
mod variation;
pub mod window;

pub use settings::{
    Acceptance, Climbers, Crossover, Encoding, FlippedBits, MemeticSettings, MutationUnit,
    Roulette, Scale, SpecialCrossover, Survival,
};

use super::{Archive, Batch, Conductor, Draft, Evaluated, Piece, Purpose, SettingsError, Told};
use crate::{
    random::{Phase, Streams},
    space::{Axis, Interval, Space},
};
use chromosome::{Chromosome, Codec};
use climb::{Climb, Craft};
use selection::{Wheel, best, worst};

/// A chromosome with its result.
#[derive(Clone, Debug)]
struct Individual {
    chromosome: Chromosome,
    told: Told,
}

/// What the running batch is.
enum Stage {
    /// Nothing has been planned.
    Start,
    /// The initial population, or the children of a generation.
    Evaluating(Vec<Chromosome>),
    /// Children live; the climb goes on.
    Climbing(Climb),
}

/// The algorithm as a piece of a strategy.
pub struct Memetic {
    craft: Craft,
    /// Chromosomes that open the initial population; the rest is random.
    start: Vec<Chromosome>,
    population: Vec<Individual>,
    generation: u32,
    stage: Stage,
}

/// The algorithm alone, over the whole space.
///
/// # Errors
/// If a setting lies outside its range.
pub fn build(
    settings: &MemeticSettings,
    space: &Space,
    seed: u64,
) -> Result<Conductor, SettingsError> {
    let intervals = space.axes().iter().map(Axis::interval).collect();
    let streams = Streams::new(seed, 0);
    let memetic = Memetic::new(settings.clone(), (space, intervals), &[], streams)?;
    Ok(Conductor::new(
        vec![Box::new(memetic)],
        settings.reuse_clones,
    ))
}

impl Memetic {
    /// The algorithm in the part of a space that `intervals` (coordinate) cover. The first members
    /// of the initial population are the points of `start` (coordinate), the others are random.
    ///
    /// # Errors
    /// If a setting lies outside its range.
    pub fn new(
        settings: MemeticSettings,
        (space, intervals): (&Space, Vec<Interval>),
        start: &[Vec<f64>],
        streams: Streams,
    ) -> Result<Self, SettingsError> {
        settings.check()?;
        let codec = Codec::new(space, intervals, &settings);
        let start = start.iter().map(|point| codec.encode(point)).collect();
        Ok(Self {
            craft: Craft {
                settings,
                codec,
                streams,
            },
            start,
            population: Vec::new(),
            generation: 0,
            stage: Stage::Start,
        })
    }

    fn initial(&self) -> Vec<Chromosome> {
        let (codec, size) = (&self.craft.codec, self.craft.settings.population);
        let random = (0..size)
            .map(|index| codec.random(&mut self.craft.streams.at(0, Phase::Initial, index)));
        let mut population: Vec<_> = self.start.iter().take(size).cloned().collect();
        population.extend(random.skip(population.len()));
        population
    }

    /// Children of this generation: roulette, crossover in pairs, mutation.
    fn breed(&self) -> Vec<Chromosome> {
        let Craft {
            settings,
            codec,
            streams,
        } = &self.craft;
        let wheel = Wheel::new(&self.population, settings.roulette);
        let mut children: Vec<Chromosome> = (0..settings.population)
            .map(|index| {
                let mut stream = streams.at(self.generation, Phase::Selection, index);
                self.population[wheel.draw(&mut stream)].chromosome.clone()
            })
            .collect();
        for (pair, both) in children.chunks_exact_mut(2).enumerate() {
            let mut stream = streams.at(self.generation, Phase::Crossover, pair);
            if let [a, b] = both
                && stream.chance(settings.crossover_probability)
            {
                variation::cross(codec, settings.crossover, (a, b), &mut stream);
            }
        }
        let rule = (
            settings.mutation_unit,
            settings.mutation_probability,
            settings.real_step,
        );
        for (index, child) in children.iter_mut().enumerate() {
            let mut stream = streams.at(self.generation, Phase::Mutation, index);
            variation::mutate(codec, child, rule, &mut stream);
        }
        children
    }

    /// Selection alone, of the literal reading: nothing needs an evaluation.
    fn select(&self) -> Vec<Individual> {
        let Craft {
            settings, streams, ..
        } = &self.craft;
        let wheel = Wheel::new(&self.population, settings.roulette);
        let drawn = (0..settings.population).map(|index| {
            let mut stream = streams.at(self.generation, Phase::Selection, index);
            self.population[wheel.draw(&mut stream)].clone()
        });
        drawn.collect()
    }

    /// Puts the next generation in place of the population.
    fn survive(&mut self, mut children: Vec<Individual>) {
        if self.population.is_empty() {
            self.population = children;
            return;
        }
        match self.craft.settings.survival {
            Survival::Generational => {
                let elite = self.population[best(&self.population)].clone();
                if elite.told.beats(children[best(&children)].told) {
                    let last = worst(&children);
                    children[last] = elite;
                }
            }
            Survival::Plus => {
                let mut all = std::mem::take(&mut self.population);
                all.append(&mut children);
                all.sort_by(|a, b| a.told.order(b.told));
                all.truncate(self.craft.settings.population);
                children = all;
            }
        }
        self.population = children;
    }

    /// Starts the next generation: its first batch, or none after the last.
    fn next_generation(&mut self) -> Option<Vec<Draft>> {
        if self.generation >= self.craft.settings.bred_generations() {
            return None;
        }
        self.generation += 1;
        if self.craft.settings.climbers == Climbers::Literal {
            let selected = self.select();
            self.survive(selected);
            self.stage =
                Stage::Climbing(Climb::new(&self.craft, self.generation, &self.population));
            return Some(Vec::new());
        }
        Some(self.evaluate(self.breed(), Purpose::Offspring))
    }

    fn evaluate(&mut self, chromosomes: Vec<Chromosome>, purpose: Purpose) -> Vec<Draft> {
        let decode = |chromosome| Draft {
            genes: self.craft.codec.decode(chromosome),
            purpose,
        };
        let drafts = chromosomes.iter().map(decode).collect();
        self.stage = Stage::Evaluating(chromosomes);
        drafts
    }
}

impl Piece for Memetic {
    fn plan(&mut self, _archive: &Archive) -> Option<Batch> {
        loop {
            let drafts = match &mut self.stage {
                Stage::Start => Some(self.evaluate(self.initial(), Purpose::Initial)),
                Stage::Evaluating(_) => self.next_generation(),
                Stage::Climbing(climb) => {
                    let attempts = climb.plan(&self.craft, &self.population);
                    let draft = |attempt: &climb::Attempt| Draft {
                        genes: self.craft.codec.decode(&attempt.chromosome),
                        purpose: attempt.purpose,
                    };
                    let drafts: Vec<Draft> = attempts.iter().map(draft).collect();
                    if drafts.is_empty() {
                        self.next_generation()
                    } else {
                        Some(drafts)
                    }
                }
            }?;
            if !drafts.is_empty() {
                return Some(Batch {
                    generation: self.generation,
                    drafts,
                });
            }
        }
    }

    fn absorb(&mut self, results: &[Evaluated]) {
        let told: Vec<Told> = results.iter().map(|result| result.told).collect();
        match &mut self.stage {
            Stage::Start => {}
            Stage::Evaluating(chromosomes) => {
                let newcomers = std::mem::take(chromosomes).into_iter().zip(told);
                let children = newcomers
                    .map(|(chromosome, told)| Individual { chromosome, told })
                    .collect();
                self.survive(children);
                if self.generation > 0 {
                    let climb = Climb::new(&self.craft, self.generation, &self.population);
                    self.stage = Stage::Climbing(climb);
                }
            }
            Stage::Climbing(climb) => climb.absorb(&self.craft, &mut self.population, &told),
        }
    }

    fn generations(&self) -> u32 {
        self.craft.settings.bred_generations()
    }

    /// Speculative trials that are discarded are not foreseen.
    fn remaining(&self) -> u64 {
        let settings = &self.craft.settings;
        let size = settings.population as u64;
        let trials = match settings.climbers {
            Climbers::Elite => (settings.crossover_trials + settings.mutation_trials) as u64,
            Climbers::All | Climbers::Literal => 2 * size,
        };
        let children = if settings.climbers == Climbers::Literal {
            0
        } else {
            size
        };
        let ahead = u64::from(self.generations().saturating_sub(self.generation));
        let running = match &self.stage {
            Stage::Start => size,
            Stage::Evaluating(waiting) if self.generation == 0 => waiting.len() as u64,
            Stage::Evaluating(waiting) => waiting.len() as u64 + trials,
            Stage::Climbing(climb) => climb.remaining() as u64,
        };
        running + ahead * (children + trials)
    }

    fn reached_threshold(&self) -> bool {
        let Some(threshold) = self.craft.settings.threshold else {
            return false;
        };
        let reached = |one: &Individual| one.told.survived() && one.told.fitness <= threshold;
        self.population.iter().any(reached)
    }
}

#[cfg(test)]
mod tests;
