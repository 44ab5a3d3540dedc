//! The memetic algorithm without generations: a deterministic sliding window instead of a barrier.
//!
//! ```text
//! individual k is bred from the population after results 0 ..= k - L, taken in index order
//! ```
//!
//! `L`, the window, is a constant of the run. At most `L` individuals are open at a time, and a slot waits
//! only if the oldest of them is still being computed when all the others are done. The search is a function
//! of the case, the settings and the seed alone, independent of the number of workers, the order of their
//! results and lost workers. `L = 1` is the sequential steady state; a larger `L` means breeding from older
//! results. Three individuals per worker keep workers of mixed speed busy (the coordinator's simulated
//! cluster measures it).
//!
//! Operators, encoding and hill-climbing trials are those of the generational algorithm. A result replaces
//! the worst of the population if it is better; of every `population + trials` individuals, `trials` are
//! hill-climbing trials from the current elite, evenly spread, the others are children of two parents. The
//! first individuals are random: a population, or as many as are needed for the first child to be bred from
//! half a population.
//!
//! The cost of breeding from older results, in medians of 25 seeds after 4,880 evaluations with the paper's
//! settings (`cargo run --release -p bench -- window` reproduces the table; fitness, smaller is
//! better):
//!
//! | function | generations | L = 1 | L = 16 | L = 48 | L = 120 | L = 240 |
//! |---|---|---|---|---|---|---|
//! | sphere | 1.0e-2 | 1.3e-2 | 1.0e-2 | 1.3e-2 | 1.3e-2 | 3.0e-3 |
//! | rastrigin | 2.4e-1 | 2.5e-1 | 2.6e-1 | 2.4e-1 | 2.4e-1 | 1.0e-1 |
//! | cliff | 1.3e-2 | 1.3e-2 | 1.0e-2 | 2.2e-2 | 1.0e-2 | 2.7e-3 |
//! | resonance | 2.5e-3 | 9.2e-3 | 5.2e-3 | 2.5e-3 | 2.5e-3 | 1.3e-3 |
//!
//! No window from 48 on has a cost that these functions could show; on the narrow valley of the resonance the
//! smallest windows are two to four times worse than generations.
use super::{
    chromosome::Chromosome,
    operators::{DrawAddress, Operators},
    population::{Individual, best, diversity, worst},
    settings::{MemeticSettings, SETTINGS},
};
use crate::{
    random::{Phase, Streams},
    space::{Axis, Space},
    strategy::{
        archive::{Archive, EvaluatedIndividual},
        ask_tell::Strategy,
        definition::{Preset, SettingGroup},
        evaluation_result::EvaluationResult,
        outcome::{Best, Finish, Progress},
        proposal::{Proposal, Purpose},
        setting::{AllowedValues, Setting, SettingsError, check, settings},
        settings::{Settings, StrategySettings, build_as},
    },
};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};

/// Preset of the memetic algorithm with the paper's settings, without generations.
pub const WINDOW: Preset = Preset {
    name: "window",
    summary: "the paper's algorithm without generations: no worker waits, results stay the same",
    strategy: WindowSettings::STRATEGY,
    settings: |plan| Settings::of(&WindowSettings::for_workers(plan.workers)),
    groups: &[
        SettingGroup::whole(WINDOWED),
        SettingGroup {
            prefix: "",
            pointer: "/memetic",
            table: SETTINGS,
            excluded: &[
                "climbers",
                "acceptance",
                "survival",
                "speculation",
                "reuse_clones",
            ],
        },
    ],
    slots: 32,
    build: build_as::<WindowSettings>,
};

settings! {
    /// Settings of the sliding-window memetic algorithm.
    pub struct WindowSettings, table WINDOWED {
        /// Window L: individual k is bred from results 0 to k - L. Three times the number of workers keeps nearly
        /// all of them busy.
        pub window: usize =
            "lag in results of the population that an individual is bred from; 3 per planned worker",
            AllowedValues::Whole(1, 1_000_000), following_workers();
        /// Operators, population and trials; the number of evaluations is `generations` times population and
        /// trials, plus the first population. Climbers, acceptance, survival and speculation are ignored.
        pub memetic: MemeticSettings;
    }
}

impl WindowSettings {
    /// Returns the paper's settings, with a window that keeps the given number of workers busy.
    pub const fn for_workers(workers: usize) -> Self {
        Self {
            window: Self::window_for(workers),
            memetic: MemeticSettings::paper(),
        }
    }

    /// Returns the window that keeps this number of workers busy.
    pub const fn window_for(workers: usize) -> usize {
        if workers == 0 { 3 } else { 3 * workers }
    }
}

impl StrategySettings for WindowSettings {
    const STRATEGY: &'static str = "window";

    fn build(&self, space: &Space, seed: u64) -> Result<Box<dyn Strategy>, SettingsError> {
        Ok(Box::new(Window::new(self, space, seed)?))
    }
}

/// Memetic search with a sliding window instead of generations, as a strategy.
pub struct Window {
    /// Window L: individual k is bred from results 0 to k - L.
    lag: usize,
    operators: Operators,
    population: Vec<Individual>,
    /// Chromosomes of the proposed individuals whose results have not been consumed, in id order.
    open: VecDeque<Chromosome>,
    outbox: Vec<Proposal>,
    early: BTreeMap<u64, EvaluationResult>,
    archive: Archive,
    next: u64,
    finish: Option<Finish>,
}

impl Window {
    /// Creates the search over the whole space.
    ///
    /// # Errors
    /// If a setting lies outside its range.
    pub fn new(settings: &WindowSettings, space: &Space, seed: u64) -> Result<Self, SettingsError> {
        check(settings, WINDOWED)?;
        let intervals = space.axes().iter().map(Axis::interval).collect();
        let streams = Streams::new(seed, 0);
        let mut window = Self {
            lag: settings.window,
            operators: Operators::new(settings.memetic.clone(), space, intervals, streams)?,
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

    /// Returns the number of random individuals proposed before the first child is bred.
    fn first(&self) -> u64 {
        let population = self.operators.settings.population;
        population.max(self.lag + population / 2) as u64
    }

    /// Returns the period of the repeating sequence of children and hill-climbing trials: population plus
    /// trials.
    const fn cycle(&self) -> u64 {
        (self.operators.settings.population + self.trials()) as u64
    }

    const fn trials(&self) -> usize {
        self.operators.settings.crossover_trials + self.operators.settings.mutation_trials
    }

    fn planned(&self) -> u64 {
        let generations = u64::from(self.operators.settings.bred_generations());
        self.first() + generations * self.cycle()
    }

    /// Returns the generation to which individual `id` would belong, for progress reports.
    fn generation(&self, id: u64) -> u32 {
        let bred = id.checked_sub(self.first());
        bred.map_or(0, |bred| {
            u32::try_from(bred / self.cycle() + 1).unwrap_or(u32::MAX)
        })
    }

    /// Returns the purpose of individual `id`: member of the initial population, child or hill-climbing
    /// trial; both kinds of trial are spread evenly over the search.
    fn purpose(&self, id: u64) -> Purpose {
        let Some(bred) = id.checked_sub(self.first()) else {
            return Purpose::Initial;
        };
        let place = usize::try_from(bred % self.cycle()).unwrap_or(0);
        let cycle = self.operators.settings.population + self.trials();
        let before = place * self.trials() / cycle;
        if (place + 1) * self.trials() / cycle == before {
            return Purpose::Offspring;
        }
        let (crossovers, all) = (self.operators.settings.crossover_trials, self.trials());
        if (before + 1) * crossovers / all > before * crossovers / all {
            Purpose::CrossoverTrial
        } else {
            Purpose::MutationTrial
        }
    }

    /// Proposes every individual whose parents are determined by the results consumed so far.
    fn propose(&mut self) {
        let consumed = self.archive.entries().len() as u64;
        // individual k needs results 0 ..= k - L; random ones need none
        let bound = (consumed + self.lag as u64)
            .max(self.first())
            .min(self.planned());
        while self.next < bound && self.finish.is_none() {
            let purpose = self.purpose(self.next);
            let chromosome = self.breed(self.next, purpose);
            self.outbox.push(Proposal {
                id: self.next,
                genes: self.operators.codec.decode(&chromosome),
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
        if purpose == Purpose::Initial {
            return self.operators.first(index);
        }
        let (operators, population) = (&self.operators, &self.population);
        let at = DrawAddress {
            generation: 1,
            index,
        };
        let wheel = operators.wheel(population);
        let elite = &population[best(population)].chromosome;
        let diversity = || diversity(&operators.codec, population);
        if purpose == Purpose::CrossoverTrial {
            return operators.crossover_trial(at, elite, diversity(), |stream| {
                &population[wheel.draw(stream)].chromosome
            });
        }
        if purpose == Purpose::MutationTrial {
            return operators.mutation_trial(at, elite, diversity());
        }
        let mut stream = operators.stream(at, Phase::Selection);
        let mut child = population[wheel.draw(&mut stream)].chromosome.clone();
        let mut other = population[wheel.draw(&mut stream)].chromosome.clone();
        operators.cross(at, &mut child, &mut other);
        operators.mutate(at, Phase::Mutation, &mut child);
        child
    }

    /// Consumes the result of individual `id`, the next in order, and updates the population.
    fn consume(&mut self, id: u64, chromosome: Chromosome, told: EvaluationResult) {
        self.archive.push(EvaluatedIndividual {
            id,
            genes: self.operators.codec.decode(&chromosome),
            result: told,
            residual: None,
        });
        let threshold = self.operators.settings.threshold;
        if told.survived() && threshold.is_some_and(|threshold| told.fitness <= threshold) {
            self.finish = Some(Finish::Threshold);
        }
        let known = |one: &Individual| one.chromosome == chromosome;
        if self.population.len() < self.operators.settings.population {
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

    fn tell(&mut self, id: u64, result: EvaluationResult) {
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
        let best = self.archive.best().filter(|best| best.result.survived());
        Progress {
            generation: self.generation(evaluations.saturating_sub(1)),
            generations: self.operators.settings.bred_generations(),
            evaluations,
            expected_evaluations: planned,
            best_fitness: best.map(|best| best.result.fitness),
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
#[path = "window_tests.rs"]
mod tests;
