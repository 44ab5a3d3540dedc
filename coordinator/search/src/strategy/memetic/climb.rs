//! The hill climbs of one generation (paper, steps 7 and 8), with exact speculation.
//!
//! A sequential climb starts trial t + 1 from the winner of trial t. As every trial draws from a
//! stream of its own, all trials that remain can be evaluated at once from the current elite;
//! those up to the first success are what the sequential climb would have done, the rest is
//! discarded and drawn again from the new elite. The elite takes the same path, bit for bit.
use super::{
    Individual,
    chromosome::{Chromosome, Codec, distance},
    selection::{Wheel, best},
    settings::{Acceptance, Climbers, FlippedBits, MemeticSettings, SpecialCrossover},
    variation,
};
use crate::{
    random::{Phase, Streams},
    strategy::{Purpose, Told},
};

/// What trials are made with; the same all through a run.
pub(super) struct Craft {
    pub(super) settings: MemeticSettings,
    pub(super) codec: Codec,
    pub(super) streams: Streams,
}

/// One planned trial; the index is part of its random address.
#[derive(Clone, Copy, Debug)]
struct Trial {
    purpose: Purpose,
    index: usize,
}

/// A trial that is being evaluated.
#[derive(Clone, Debug)]
pub(super) struct Attempt {
    pub(super) purpose: Purpose,
    pub(super) chromosome: Chromosome,
    /// Position in the population of the individual it would replace.
    target: usize,
}

/// The climbs of one generation.
#[derive(Debug)]
pub(super) struct Climb {
    generation: u32,
    /// Trials that are still to be done, in order.
    trials: Vec<Trial>,
    /// How much the population differed from its elite when the climb began [0 to 1].
    diversity: f64,
    attempts: Vec<Attempt>,
}

impl Climb {
    pub(super) fn new(craft: &Craft, generation: u32, population: &[Individual]) -> Self {
        let settings = &craft.settings;
        let trials = match settings.climbers {
            Climbers::Elite => {
                let first = plan(Purpose::CrossoverTrial, settings.crossover_trials);
                first
                    .chain(plan(Purpose::MutationTrial, settings.mutation_trials))
                    .collect()
            }
            Climbers::All => {
                let first = plan(Purpose::CrossoverTrial, population.len());
                first
                    .chain(plan(Purpose::MutationTrial, population.len()))
                    .collect()
            }
            Climbers::Literal => literal_trials(craft, generation, population.len()),
        };
        Self {
            generation,
            trials,
            diversity: diversity(&craft.codec, population),
            attempts: Vec::new(),
        }
    }

    /// Trials that have not been decided.
    pub(super) fn remaining(&self) -> usize {
        self.trials.len()
    }

    /// The next trials to evaluate at once; empty when the climb is over.
    pub(super) fn plan(&mut self, craft: &Craft, population: &[Individual]) -> &[Attempt] {
        let width = self.width(craft);
        let elite = best(population);
        let wheel = Wheel::new(population, craft.settings.roulette);
        self.attempts.clear();
        for &trial in self.trials.iter().take(width) {
            let target = match craft.settings.climbers {
                Climbers::All => trial.index,
                Climbers::Elite | Climbers::Literal => elite,
            };
            let chromosome = self.draw(craft, population, &wheel, (trial, target));
            self.attempts.push(Attempt {
                purpose: trial.purpose,
                chromosome,
                target,
            });
        }
        &self.attempts
    }

    /// Takes the results of the planned trials and improves the population in place.
    pub(super) fn absorb(&mut self, craft: &Craft, population: &mut [Individual], told: &[Told]) {
        let attempts = std::mem::take(&mut self.attempts);
        let mut successes = attempts
            .iter()
            .zip(told)
            .enumerate()
            .filter(|(_, (attempt, told))| told.beats(population[attempt.target].told))
            .map(|(position, _)| position);
        let (winners, decided) = match (craft.settings.climbers, craft.settings.acceptance) {
            (Climbers::All, _) => (successes.collect(), attempts.len()),
            (_, Acceptance::BestOfBatch) => {
                // `min_by` keeps the first of equals
                let winner = successes.min_by(|a, b| told[*a].order(told[*b]));
                (winner.into_iter().collect(), attempts.len())
            }
            (_, Acceptance::First) => {
                let winner: Option<usize> = successes.next();
                let decided = winner.map_or(attempts.len(), |position| position + 1);
                (winner.into_iter().collect::<Vec<_>>(), decided)
            }
        };
        for position in winners {
            let attempt = &attempts[position];
            population[attempt.target] = Individual {
                chromosome: attempt.chromosome.clone(),
                told: told[position],
            };
        }
        self.trials.drain(..decided.min(self.trials.len()));
    }

    /// How many trials may be evaluated at once.
    fn width(&self, craft: &Craft) -> usize {
        let all = self.trials.len();
        match (craft.settings.climbers, craft.settings.acceptance) {
            (Climbers::All, _) => {
                // the mutation of an individual starts from what its crossover left
                let kind = self.trials.first().map(|trial| trial.purpose);
                self.trials
                    .iter()
                    .take_while(|trial| Some(trial.purpose) == kind)
                    .count()
            }
            (_, Acceptance::BestOfBatch) => all,
            (_, Acceptance::First) => craft.settings.speculation.unwrap_or(all).min(all),
        }
    }

    fn draw(
        &self,
        craft: &Craft,
        population: &[Individual],
        wheel: &Wheel,
        (trial, target): (Trial, usize),
    ) -> Chromosome {
        let settings = &craft.settings;
        let start = &population[target].chromosome;
        let literal = settings.climbers == Climbers::Literal;
        if trial.purpose == Purpose::CrossoverTrial {
            let mut stream = craft
                .streams
                .at(self.generation, Phase::CrossoverTrial, trial.index);
            let partner = if literal {
                trial.index
            } else {
                wheel.draw(&mut stream)
            };
            let share = match settings.special_crossover {
                SpecialCrossover::EliteBiased => (0.1 + 0.5 * self.diversity).clamp(0.1, 0.6),
                SpecialCrossover::Even => 0.5,
            };
            let partner = &population[partner].chromosome;
            return variation::elite_crossover(&craft.codec, start, partner, share, &mut stream);
        }
        let mut stream = craft
            .streams
            .at(self.generation, Phase::MutationTrial, trial.index);
        if literal {
            let rule = (
                settings.mutation_unit,
                settings.mutation_probability,
                settings.real_step,
            );
            let mut child = start.clone();
            variation::mutate(&craft.codec, &mut child, rule, &mut stream);
            return child;
        }
        let count = match settings.flipped_bits {
            FlippedBits::Fixed(count) => count,
            FlippedBits::Adaptive => adaptive_bits(self.diversity),
        };
        variation::flip_some(
            &craft.codec,
            start,
            (count, settings.real_step),
            &mut stream,
        )
    }
}

fn plan(purpose: Purpose, count: usize) -> impl Iterator<Item = Trial> {
    (0..count).map(move |index| Trial { purpose, index })
}

/// To the letter: each individual in turn starts a crossover trial, by chance, and a mutation
/// trial.
fn literal_trials(craft: &Craft, generation: u32, population: usize) -> Vec<Trial> {
    let mut trials = Vec::with_capacity(2 * population);
    for index in 0..population {
        let mut stream = craft.streams.at(generation, Phase::Crossover, index);
        if stream.chance(craft.settings.crossover_probability) {
            trials.push(Trial {
                purpose: Purpose::CrossoverTrial,
                index,
            });
        }
        trials.push(Trial {
            purpose: Purpose::MutationTrial,
            index,
        });
    }
    trials
}

/// Twice the mean share of bits in which the population differs from its elite: 1 for a random
/// population, 0 for clones.
pub(super) fn diversity(codec: &Codec, population: &[Individual]) -> f64 {
    let elite = &population[best(population)].chromosome;
    let bits: u32 = population
        .iter()
        .map(|one| distance(&one.chromosome, elite))
        .sum();
    let mean = f64::from(bits) / population.len() as f64;
    (2.0 * mean / codec.length() as f64).min(1.0)
}

/// 1 to 4 bits, more in a diverse population.
pub(super) fn adaptive_bits(diversity: f64) -> usize {
    match 3.0 * diversity {
        x if x < 0.5 => 1,
        x if x < 1.5 => 2,
        x if x < 2.5 => 3,
        _ => 4,
    }
}
