//! Hill climbs of one generation (paper, steps 7 and 8), with exact speculation.
//!
//! A sequential climb starts trial t + 1 from the winner of trial t. As every trial draws from a stream of
//! its own, all remaining trials can be evaluated at once from the current elite; those up to the first
//! success are identical to the sequential climb, the others are discarded and drawn again from the new
//! elite. The path of the elite is therefore that of the sequential climb, bit for bit.
use super::{
    chromosome::Chromosome,
    operators::{DrawAddress, Operators},
    population::{Individual, best, diversity},
    roulette::RouletteWheel,
    settings::{Acceptance, Climbers},
};
use crate::{
    random::Phase,
    strategy::{evaluation_result::EvaluationResult, proposal::Purpose},
};

/// Planned hill-climbing trial; its index selects the random stream from which it is drawn.
#[derive(Clone, Copy, Debug)]
struct Trial {
    purpose: Purpose,
    index: usize,
}

/// Hill-climbing trial whose chromosome is being evaluated.
#[derive(Clone, Debug)]
pub(super) struct Attempt {
    pub(super) purpose: Purpose,
    pub(super) chromosome: Chromosome,
    /// Index in the population of the individual that this trial replaces if it is better.
    target: usize,
}

/// State of the hill climbs of one generation.
#[derive(Debug)]
pub(super) struct Climb {
    generation: u32,
    /// Hill-climbing trials whose outcome is still undecided, in order.
    trials: Vec<Trial>,
    /// Diversity of the population relative to its elite when the climb began [0 to 1].
    diversity: f64,
    attempts: Vec<Attempt>,
}

impl Climb {
    pub(super) fn new(operators: &Operators, generation: u32, population: &[Individual]) -> Self {
        let settings = &operators.settings;
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
            Climbers::Literal => literal_trials(operators, generation, population.len()),
        };
        Self {
            generation,
            trials,
            diversity: diversity(&operators.codec, population),
            attempts: Vec::new(),
        }
    }

    pub(super) fn remaining(&self) -> usize {
        self.trials.len()
    }

    /// Plans the next hill-climbing trials, to be evaluated at once; empty when the climb is over.
    pub(super) fn plan(&mut self, operators: &Operators, population: &[Individual]) -> &[Attempt] {
        let width = self.width(operators);
        let elite = best(population);
        let wheel = operators.wheel(population);
        self.attempts.clear();
        for &trial in self.trials.iter().take(width) {
            let target = match operators.settings.climbers {
                Climbers::All => trial.index,
                Climbers::Elite | Climbers::Literal => elite,
            };
            let chromosome = self.draw(operators, population, &wheel, (trial, target));
            self.attempts.push(Attempt {
                purpose: trial.purpose,
                chromosome,
                target,
            });
        }
        &self.attempts
    }

    /// Takes the results of the planned hill-climbing trials and replaces individuals of the population by
    /// better trials.
    pub(super) fn absorb(
        &mut self,
        operators: &Operators,
        population: &mut [Individual],
        told: &[EvaluationResult],
    ) {
        let attempts = std::mem::take(&mut self.attempts);
        let mut successes = attempts
            .iter()
            .zip(told)
            .enumerate()
            .filter(|(_, (attempt, told))| told.beats(population[attempt.target].told))
            .map(|(position, _)| position);
        let (winners, decided) = match (operators.settings.climbers, operators.settings.acceptance)
        {
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

    /// Returns how many hill-climbing trials may be evaluated at the same time.
    fn width(&self, operators: &Operators) -> usize {
        let all = self.trials.len();
        match (operators.settings.climbers, operators.settings.acceptance) {
            (Climbers::All, _) => {
                // the mutation of an individual starts from what its crossover left
                let kind = self.trials.first().map(|trial| trial.purpose);
                self.trials
                    .iter()
                    .take_while(|trial| Some(trial.purpose) == kind)
                    .count()
            }
            (_, Acceptance::BestOfBatch) => all,
            (_, Acceptance::First) => operators.settings.speculation.unwrap_or(all).min(all),
        }
    }

    fn draw(
        &self,
        operators: &Operators,
        population: &[Individual],
        wheel: &RouletteWheel,
        (trial, target): (Trial, usize),
    ) -> Chromosome {
        let at = DrawAddress {
            generation: self.generation,
            index: trial.index,
        };
        let start = &population[target].chromosome;
        let literal = operators.settings.climbers == Climbers::Literal;
        if trial.purpose == Purpose::CrossoverTrial {
            return operators.crossover_trial(at, start, self.diversity, |stream| {
                let partner = if literal {
                    trial.index
                } else {
                    wheel.draw(stream)
                };
                &population[partner].chromosome
            });
        }
        if literal {
            let mut child = start.clone();
            operators.mutate(at, Phase::MutationTrial, &mut child);
            return child;
        }
        operators.mutation_trial(at, start, self.diversity)
    }
}

fn plan(purpose: Purpose, count: usize) -> impl Iterator<Item = Trial> {
    (0..count).map(move |index| Trial { purpose, index })
}

/// Plans the hill-climbing trials of the paper's literal text: each individual in turn starts a crossover
/// trial, with the crossover probability, and a mutation trial.
fn literal_trials(operators: &Operators, generation: u32, population: usize) -> Vec<Trial> {
    let mut trials = Vec::with_capacity(2 * population);
    for index in 0..population {
        let mut stream = operators.stream(DrawAddress { generation, index }, Phase::Crossover);
        if stream.chance(operators.settings.crossover_probability) {
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
