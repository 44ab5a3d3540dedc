//! The memetic algorithm without generations: a deterministic window instead of a barrier.
//!
//! ```text
//! individual k is bred from the population after results 0 ..= k - L, taken in index order
//! ```
//!
//! `L`, the window, is a constant of the run. At most `L` individuals are open at a time, and a
//! slot waits only if the oldest of them is still being computed when all the others are done. The
//! search is a function of the case, the settings and the seed alone: how many workers there are,
//! in which order they answer and who is killed does not show. `L = 1` is the sequential steady
//! state; the larger `L`, the older is what an individual is bred from. Three individuals per
//! worker keep workers of mixed speed busy (the coordinator's simulated cluster measures it).
//!
//! Operators, encoding and hill-climbing trials are those of the generational algorithm. A result
//! replaces the worst of the population if it is better; of every `population + trials`
//! individuals, `trials` are spread evenly as trials from the elite of the moment, the others are
//! children of two parents. The first individuals are random: a population, or as many as it takes
//! for the first child to be bred from half a population.
//!
//! What breeding from older results costs, in medians of 25 seeds after 4,880 evaluations with the
//! paper's settings (`cargo test -p search -- --ignored --nocapture cost_of_the_window` makes the
//! table again; fitness, smaller is better):
//!
//! | function | generations | L = 1 | L = 16 | L = 48 | L = 120 | L = 240 |
//! |---|---|---|---|---|---|---|
//! | sphere | 1.0e-2 | 1.3e-2 | 1.0e-2 | 1.3e-2 | 1.3e-2 | 3.0e-3 |
//! | rastrigin | 2.4e-1 | 2.5e-1 | 2.6e-1 | 2.4e-1 | 2.4e-1 | 1.0e-1 |
//! | cliff | 1.3e-2 | 1.3e-2 | 1.0e-2 | 2.2e-2 | 1.0e-2 | 2.7e-3 |
//! | resonance | 2.5e-3 | 9.2e-3 | 5.2e-3 | 2.5e-3 | 2.5e-3 | 1.3e-3 |
//!
//! No window from 48 on costs anything that these functions could show; on the narrow valley of the
//! resonance the smallest ones are two to four times worse than generations.
use super::{
    Codec, Individual, MemeticSettings,
    chromosome::Chromosome,
    climb::{adaptive_bits, diversity},
    selection::{Wheel, best, worst},
    settings::{FlippedBits, SpecialCrossover},
    variation,
};
use crate::{
    random::{Phase, Streams},
    space::{Axis, Space},
    strategy::{
        Archive, Best, Evaluated, Finish, Progress, Proposal, Purpose, SettingsError, Strategy,
        Told, require,
    },
};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};

/// Settings of the search without generations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindowSettings {
    /// L: individual k is bred from results 0 to k - L. Three times the number of workers keeps
    /// nearly all of them busy.
    pub window: usize,
    /// Operators, population and trials; `generations` times population and trials, and the first
    /// population, are evaluated. Climbers, acceptance, survival and speculation have no meaning
    /// here.
    pub memetic: MemeticSettings,
}

impl WindowSettings {
    /// The paper's numbers with the window of so many workers.
    pub const fn for_workers(workers: usize) -> Self {
        Self {
            window: Self::window_for(workers),
            memetic: MemeticSettings::paper(),
        }
    }

    /// The window that keeps so many workers busy.
    pub const fn window_for(workers: usize) -> usize {
        if workers == 0 { 3 } else { 3 * workers }
    }
}

/// The search, as a strategy.
pub struct Window {
    settings: WindowSettings,
    codec: Codec,
    streams: Streams,
    population: Vec<Individual>,
    /// Proposals without a consumed result, by id from the front.
    open: VecDeque<Chromosome>,
    outbox: Vec<Proposal>,
    early: BTreeMap<u64, Told>,
    archive: Archive,
    next: u64,
    finish: Option<Finish>,
}

/// The search over the whole space.
///
/// # Errors
/// If a setting lies outside its range.
pub fn build(settings: &WindowSettings, space: &Space, seed: u64) -> Result<Window, SettingsError> {
    settings.memetic.check()?;
    require(
        settings.window >= 1,
        "window",
        settings.window as f64,
        "at least 1",
    )?;
    let intervals = space.axes().iter().map(Axis::interval).collect();
    let mut window = Window {
        codec: Codec::new(space, intervals, &settings.memetic),
        settings: settings.clone(),
        streams: Streams::new(seed, 0),
        population: Vec::new(),
        open: VecDeque::new(),
        outbox: Vec::new(),
        early: BTreeMap::new(),
        archive: Archive::default(),
        next: 0,
        finish: None,
    };
    window.propose();
    Ok(window)
}

impl Window {
    /// How many individuals are random.
    fn first(&self) -> u64 {
        let population = self.settings.memetic.population;
        population.max(self.settings.window + population / 2) as u64
    }

    /// Individuals between two of the same place in the plan.
    const fn cycle(&self) -> u64 {
        (self.settings.memetic.population + self.trials()) as u64
    }

    const fn trials(&self) -> usize {
        self.settings.memetic.crossover_trials + self.settings.memetic.mutation_trials
    }

    /// How many evaluations are planned.
    fn planned(&self) -> u64 {
        let generations = u64::from(self.settings.memetic.bred_generations());
        self.first() + generations * self.cycle()
    }

    /// The generation an individual would belong to if there were any.
    fn generation(&self, id: u64) -> u32 {
        let bred = id.checked_sub(self.first());
        bred.map_or(0, |bred| {
            u32::try_from(bred / self.cycle() + 1).unwrap_or(u32::MAX)
        })
    }

    /// What an individual is for: trials are spread evenly, of either kind in turn.
    fn purpose(&self, id: u64) -> Purpose {
        let Some(bred) = id.checked_sub(self.first()) else {
            return Purpose::Initial;
        };
        let place = usize::try_from(bred % self.cycle()).unwrap_or(0);
        let cycle = self.settings.memetic.population + self.trials();
        let before = place * self.trials() / cycle;
        if (place + 1) * self.trials() / cycle == before {
            return Purpose::Offspring;
        }
        let (crossovers, all) = (self.settings.memetic.crossover_trials, self.trials());
        if (before + 1) * crossovers / all > before * crossovers / all {
            Purpose::CrossoverTrial
        } else {
            Purpose::MutationTrial
        }
    }

    /// Hands out everything that may be bred from what has been consumed.
    fn propose(&mut self) {
        let consumed = self.archive.entries().len() as u64;
        // individual k needs results 0 ..= k - L; random ones need none
        let bound = (consumed + self.settings.window as u64)
            .max(self.first())
            .min(self.planned());
        while self.next < bound && self.finish.is_none() {
            let purpose = self.purpose(self.next);
            let chromosome = self.breed(self.next, purpose);
            self.outbox.push(Proposal {
                id: self.next,
                genes: self.codec.decode(&chromosome),
                generation: self.generation(self.next),
                purpose,
            });
            self.open.push_back(chromosome);
            self.next += 1;
        }
        if self.open.is_empty() {
            self.finish.get_or_insert(Finish::Planned);
        }
    }

    fn breed(&self, id: u64, purpose: Purpose) -> Chromosome {
        let index = usize::try_from(id).unwrap_or(usize::MAX);
        let memetic = &self.settings.memetic;
        if purpose == Purpose::Initial {
            return self
                .codec
                .random(&mut self.streams.at(0, Phase::Initial, index));
        }
        let wheel = Wheel::new(&self.population, memetic.roulette);
        let elite = &self.population[best(&self.population)].chromosome;
        match purpose {
            Purpose::CrossoverTrial => {
                let mut stream = self.streams.at(1, Phase::CrossoverTrial, index);
                let partner = &self.population[wheel.draw(&mut stream)].chromosome;
                let share = match memetic.special_crossover {
                    SpecialCrossover::EliteBiased => {
                        let diversity = diversity(&self.codec, &self.population);
                        (0.1 + 0.5 * diversity).clamp(0.1, 0.6)
                    }
                    SpecialCrossover::Even => 0.5,
                };
                variation::elite_crossover(&self.codec, elite, partner, share, &mut stream)
            }
            Purpose::MutationTrial => {
                let mut stream = self.streams.at(1, Phase::MutationTrial, index);
                let count = match memetic.flipped_bits {
                    FlippedBits::Fixed(count) => count,
                    FlippedBits::Adaptive => {
                        adaptive_bits(diversity(&self.codec, &self.population))
                    }
                };
                let how = (count, memetic.real_step);
                variation::flip_some(&self.codec, elite, how, &mut stream)
            }
            Purpose::Initial
            | Purpose::Offspring
            | Purpose::Scan
            | Purpose::Refinement
            | Purpose::LeastSquares => {
                let mut stream = self.streams.at(1, Phase::Selection, index);
                let mut child = self.population[wheel.draw(&mut stream)].chromosome.clone();
                let mut other = self.population[wheel.draw(&mut stream)].chromosome.clone();
                let mut stream = self.streams.at(1, Phase::Crossover, index);
                if stream.chance(memetic.crossover_probability) {
                    let both = (&mut child, &mut other);
                    variation::cross(&self.codec, memetic.crossover, both, &mut stream);
                }
                let rule = (
                    memetic.mutation_unit,
                    memetic.mutation_probability,
                    memetic.real_step,
                );
                let mut stream = self.streams.at(1, Phase::Mutation, index);
                variation::mutate(&self.codec, &mut child, rule, &mut stream);
                child
            }
        }
    }

    /// Takes the next result in index order.
    fn consume(&mut self, id: u64, chromosome: Chromosome, told: Told) {
        self.archive.push(Evaluated {
            id,
            genes: self.codec.decode(&chromosome),
            told,
            residual: None,
        });
        let threshold = self.settings.memetic.threshold;
        if told.survived() && threshold.is_some_and(|threshold| told.fitness <= threshold) {
            self.finish = Some(Finish::Threshold);
        }
        let known = |one: &Individual| one.chromosome == chromosome;
        if self.population.len() < self.settings.memetic.population {
            self.population.push(Individual { chromosome, told });
        } else if !self.population.iter().any(known) {
            // two of a kind would crowd out the others
            let last = worst(&self.population);
            if told.beats(self.population[last].told) {
                self.population[last] = Individual { chromosome, told };
            }
        }
    }
}

impl Strategy for Window {
    fn ask(&mut self) -> Vec<Proposal> {
        std::mem::take(&mut self.outbox)
    }

    fn tell(&mut self, id: u64, result: Told) {
        let consumed = self.archive.entries().len() as u64;
        if id < consumed || id >= self.next {
            return;
        }
        self.early.entry(id).or_insert(result);
        while self.finish.is_none() {
            let next = self.archive.entries().len() as u64;
            let Some(told) = self.early.remove(&next) else {
                break;
            };
            let Some(chromosome) = self.open.pop_front() else {
                break;
            };
            self.consume(next, chromosome, told);
            // after each result, whatever else has arrived: individual k sees 0 ..= k - L, no more
            self.propose();
        }
        if self.finish.is_some() {
            self.outbox.clear();
        }
    }

    fn finished(&self) -> Option<Finish> {
        self.finish
    }

    fn progress(&self) -> Progress {
        let evaluations = self.archive.entries().len() as u64;
        let planned = match self.finish {
            Some(_) => evaluations,
            None => self.planned(),
        };
        let best = self.archive.best().filter(|best| best.told.survived());
        Progress {
            generation: self.generation(evaluations.saturating_sub(1)),
            generations: self.settings.memetic.bred_generations(),
            evaluations,
            expected_evaluations: planned,
            best_fitness: best.map(|best| best.told.fitness),
        }
    }

    fn best(&self) -> Option<Best> {
        self.archive.best().map(Best::from)
    }

    fn archive(&self) -> &Archive {
        &self.archive
    }
}

#[cfg(test)]
mod tests;
