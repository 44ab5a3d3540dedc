//! The paper's memetic algorithm, generation by generation.
//!
//! Parents by roulette, uniform crossover, bit mutation, one elite kept; then hill climbing of the elite by
//! crossovers with partners and by flips of a few random bits, accepting every improvement.
use super::{
    chromosome::Chromosome,
    climb::{Attempt, Climb},
    operators::{DrawAddress, Operators},
    population::{Individual, best, worst},
    settings::{Climbers, MemeticSettings, SETTINGS, Survival},
};
use crate::{
    random::{Phase, Streams},
    space::{Axis, Interval, Space},
    strategy::{
        archive::{Archive, EvaluatedIndividual},
        ask_tell::Strategy,
        definition::{Preset, SettingGroup},
        evaluation_result::EvaluationResult,
        proposal::Purpose,
        sequencer::Sequencer,
        setting::SettingsError,
        settings::{Settings, StrategySettings, build_as},
        stage::{Batch, ProposalDraft, SearchStage},
    },
};

/// Preset of the memetic algorithm with the paper's settings.
pub const PAPER: Preset = Preset {
    name: "paper",
    summary: "the reference paper's memetic algorithm: 80 individuals, 60 generations",
    strategy: MemeticSettings::STRATEGY,
    settings: |_| Settings::of(&MemeticSettings::paper()),
    groups: &[SettingGroup::whole(SETTINGS)],
    slots: 8,
    build: build_as::<MemeticSettings>,
};

/// Preset of the memetic algorithm with the paper's settings, where the trials of a hill climb are evaluated
/// in batches.
pub const PAPER_BATCH: Preset = Preset {
    name: "paper-batch",
    summary: "the paper's algorithm with the best of 40 + 40 climbing trials at once",
    settings: |_| Settings::of(&MemeticSettings::paper_batch()),
    slots: 24,
    ..PAPER
};

impl StrategySettings for MemeticSettings {
    const STRATEGY: &'static str = "memetic";

    /// Builds a search that consists of the memetic algorithm alone, over the whole space.
    fn build(&self, space: &Space, seed: u64) -> Result<Box<dyn Strategy>, SettingsError> {
        let intervals = space.axes().iter().map(Axis::interval).collect();
        let streams = Streams::new(seed, 0);
        let memetic = Memetic::new(self.clone(), (space, intervals), &[], streams)?;
        let stages: Vec<Box<dyn SearchStage>> = vec![Box::new(memetic)];
        Ok(Box::new(Sequencer::new(stages, self.reuse_clones)))
    }
}

/// State of the memetic algorithm, which tells what the running batch contains.
enum Step {
    /// No batch has been planned yet.
    Start,
    /// Evaluation of the initial population or of the children of a generation.
    Evaluating(Vec<Chromosome>),
    /// Hill climb after the children of a generation have been evaluated.
    Climbing(Climb),
}

/// Memetic algorithm as one batch-wise part (stage) of a strategy.
pub struct Memetic {
    operators: Operators,
    /// Chromosomes with which the initial population begins; its other members are random.
    start: Vec<Chromosome>,
    population: Vec<Individual>,
    generation: u32,
    step: Step,
}

impl Memetic {
    /// Creates the algorithm in the part of a space that `intervals` (coordinate) cover. The first members of
    /// the initial population are the points of `start` (coordinate), the others are random.
    ///
    /// # Errors
    /// If a setting lies outside its range.
    pub fn new(
        settings: MemeticSettings,
        (space, intervals): (&Space, Vec<Interval>),
        start: &[Vec<f64>],
        streams: Streams,
    ) -> Result<Self, SettingsError> {
        let operators = Operators::new(settings, space, intervals, streams)?;
        let start = start.iter().map(|point| operators.codec.encode(point));
        Ok(Self {
            start: start.collect(),
            operators,
            population: Vec::new(),
            generation: 0,
            step: Step::Start,
        })
    }

    fn initial(&self) -> Vec<Chromosome> {
        let size = self.operators.settings.population;
        let mut population: Vec<_> = self.start.iter().take(size).cloned().collect();
        population.extend((population.len()..size).map(|index| self.operators.first(index)));
        population
    }

    /// Creates the children of this generation: roulette, crossover in pairs, mutation.
    fn breed(&self) -> Vec<Chromosome> {
        let selected = self.select();
        let mut children: Vec<_> = selected.into_iter().map(|one| one.chromosome).collect();
        for (pair, both) in children.chunks_exact_mut(2).enumerate() {
            if let [a, b] = both {
                self.operators.cross(self.at(pair), a, b);
            }
        }
        for (index, child) in children.iter_mut().enumerate() {
            self.operators
                .mutate(self.at(index), Phase::Mutation, child);
        }
        children
    }

    /// Draws a new population from the current one by roulette.
    fn select(&self) -> Vec<Individual> {
        let wheel = self.operators.wheel(&self.population);
        let drawn = (0..self.operators.settings.population).map(|index| {
            let mut stream = self.operators.stream(self.at(index), Phase::Selection);
            self.population[wheel.draw(&mut stream)].clone()
        });
        drawn.collect()
    }

    const fn at(&self, index: usize) -> DrawAddress {
        DrawAddress {
            generation: self.generation,
            index,
        }
    }

    /// Replaces the population by the survivors among parents and children.
    fn survive(&mut self, mut children: Vec<Individual>) {
        if self.population.is_empty() {
            self.population = children;
            return;
        }
        match self.operators.settings.survival {
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
                all.truncate(self.operators.settings.population);
                children = all;
            }
        }
        self.population = children;
    }

    /// Starts the next generation and returns its first batch; `None` after the last generation.
    fn next_generation(&mut self) -> Option<Vec<ProposalDraft>> {
        if self.generation >= self.operators.settings.bred_generations() {
            return None;
        }
        self.generation += 1;
        if self.operators.settings.climbers == Climbers::Literal {
            let selected = self.select();
            self.survive(selected);
            self.step = Step::Climbing(Climb::new(
                &self.operators,
                self.generation,
                &self.population,
            ));
            return Some(Vec::new());
        }
        Some(self.evaluate(self.breed(), Purpose::Offspring))
    }

    fn evaluate(&mut self, chromosomes: Vec<Chromosome>, purpose: Purpose) -> Vec<ProposalDraft> {
        let decode = |chromosome| ProposalDraft {
            genes: self.operators.codec.decode(chromosome),
            purpose,
        };
        let drafts = chromosomes.iter().map(decode).collect();
        self.step = Step::Evaluating(chromosomes);
        drafts
    }
}

impl SearchStage for Memetic {
    fn plan(&mut self, _archive: &Archive) -> Option<Batch> {
        loop {
            let drafts = match &mut self.step {
                Step::Start => Some(self.evaluate(self.initial(), Purpose::Initial)),
                Step::Evaluating(_) => self.next_generation(),
                Step::Climbing(climb) => {
                    let attempts = climb.plan(&self.operators, &self.population);
                    let draft = |attempt: &Attempt| ProposalDraft {
                        genes: self.operators.codec.decode(&attempt.chromosome),
                        purpose: attempt.purpose,
                    };
                    let drafts: Vec<ProposalDraft> = attempts.iter().map(draft).collect();
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

    fn absorb(&mut self, results: &[EvaluatedIndividual]) {
        let told: Vec<EvaluationResult> = results.iter().map(|result| result.result).collect();
        match &mut self.step {
            Step::Start => {}
            Step::Evaluating(chromosomes) => {
                let newcomers = std::mem::take(chromosomes).into_iter().zip(told);
                let children = newcomers
                    .map(|(chromosome, told)| Individual { chromosome, told })
                    .collect();
                self.survive(children);
                if self.generation > 0 {
                    let climb = Climb::new(&self.operators, self.generation, &self.population);
                    self.step = Step::Climbing(climb);
                }
            }
            Step::Climbing(climb) => climb.absorb(&self.operators, &mut self.population, &told),
        }
    }

    fn generations(&self) -> u32 {
        self.operators.settings.bred_generations()
    }

    /// Returns the expected number of remaining evaluations, not counting speculative trials that will be
    /// discarded.
    fn remaining(&self) -> u64 {
        let settings = &self.operators.settings;
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
        let running = match &self.step {
            Step::Start => size,
            Step::Evaluating(waiting) if self.generation == 0 => waiting.len() as u64,
            Step::Evaluating(waiting) => waiting.len() as u64 + trials,
            Step::Climbing(climb) => climb.remaining() as u64,
        };
        running + ahead * (children + trials)
    }

    fn reached_threshold(&self) -> bool {
        let Some(threshold) = self.operators.settings.threshold else {
            return false;
        };
        let reached = |one: &Individual| one.told.survived() && one.told.fitness <= threshold;
        self.population.iter().any(reached)
    }
}
