//! L-SHADE: differential evolution that adapts its factors to successful trials, with a shrinking population.
//!
//! Tanabe and Fukunaga, "Improving the search performance of SHADE using linear population size reduction"
//! (CEC 2014): `v = x + F (x_pbest - x) + F (x_r1 - x_r2)` with `x_r2` from population and archive, binomial
//! crossover, memories of `F` and `CR` by weighted Lehmer and arithmetic means, `N` decreasing linearly with
//! the evaluations. Only the order of results and the sizes of gains count; failures are ranked last and gain
//! nothing.
use super::{
    archive::{Archive, EvaluatedIndividual},
    ask_tell::Strategy,
    definition::{Preset, SettingGroup},
    design::{hypercube, prepend_starts},
    evaluation_result::EvaluationResult,
    proposal::Purpose,
    sequencer::Sequencer,
    setting::{AllowedValues, Setting, SettingsError, check, settings},
    settings::{Settings, StrategySettings, build_as},
    stage::{Batch, ProposalDraft, SearchStage},
};
use crate::{
    random::{Phase, Stream, Streams},
    space::{Axis, Interval, Space},
};
use serde::{Deserialize, Serialize};

/// Preset of L-SHADE.
pub const L_SHADE: Preset = Preset {
    name: "l-shade",
    summary: "L-SHADE: differential evolution with adaptive factors and a shrinking population",
    strategy: LShadeSettings::STRATEGY,
    settings: |plan| Settings::of(&LShadeSettings::for_dimension(plan.space.dimension())),
    groups: &[SettingGroup::whole(SETTINGS)],
    slots: 4,
    build: build_as::<LShadeSettings>,
};

settings! {
    /// Settings of L-SHADE.
    pub struct LShadeSettings, table SETTINGS {
        pub population: usize = "individuals per generation", AllowedValues::Whole(4, 100_000);
        /// Number of memory slots for the factors `F` and `CR` of successful trials; each generation writes one
        /// slot.
        pub memory: usize = "number of memory entries for successful factors", AllowedValues::Whole(1, 1000);
        pub best: f64 =
            "share of the population, best first, from which the attractor of a mutation is drawn",
            AllowedValues::Real(0.01, 1.0);
        pub archive: f64 =
            "replaced individuals that are kept, as a share of the population",
            AllowedValues::Real(0.0, 10.0);
        pub evaluations: usize = "total number of evaluations", AllowedValues::Whole(4, 100_000_000);
    }
}

impl LShadeSettings {
    /// Returns the settings for `n` unknowns: the published numbers, but a smaller population, because a
    /// thousand evaluations are few.
    pub const fn for_dimension(n: usize) -> Self {
        let population = if n < 5 { 20 } else { 4 * n };
        Self {
            population,
            memory: 6,
            best: 0.11,
            archive: 2.6,
            evaluations: 1000,
        }
    }
}

impl StrategySettings for LShadeSettings {
    const STRATEGY: &'static str = "l-shade";

    fn build(&self, space: &Space, seed: u64) -> Result<Box<dyn Strategy>, SettingsError> {
        check(self, SETTINGS)?;
        let stage = LShade {
            memories: vec![[0.5; 2]; self.memory],
            oldest: 0,
            settings: self.clone(),
            space: space.clone(),
            streams: Streams::new(seed, 0),
            population: Vec::new(),
            replaced: Vec::new(),
            planned: 0,
            generation: 0,
            trials: Vec::new(),
        };
        Ok(Box::new(Sequencer::new(vec![Box::new(stage)], false)))
    }
}

const FEWEST: usize = 4;

/// L-SHADE as one batch-wise part (stage) of a strategy.
struct LShade {
    settings: LShadeSettings,
    space: Space,
    streams: Streams,
    /// Coordinates of the individuals with their results, best first.
    population: Vec<(Vec<f64>, EvaluationResult)>,
    /// Coordinates of individuals that better trials replaced (the archive of L-SHADE).
    replaced: Vec<Vec<f64>>,
    /// Memory of L-SHADE: slots with the means of successful factors `F` and `CR`.
    memories: Vec<[f64; 2]>,
    oldest: usize,
    planned: usize,
    generation: u32,
    /// Trial points of the running batch (coordinates), each with the factors `F` and `CR` that produced it.
    trials: Vec<(Vec<f64>, [f64; 2])>,
}

impl LShade {
    fn first(&self, count: usize) -> Vec<(Vec<f64>, [f64; 2])> {
        let trust: Vec<Interval> = self.space.axes().iter().map(|axis| axis.trust).collect();
        let others = hypercube(&trust, count.saturating_sub(1), self.streams);
        let points = prepend_starts(&self.space, others);
        let points = points.into_iter().take(count);
        points.map(|x| (x, [0.0; 2])).collect()
    }

    /// Creates the trial point that competes with the individual at index `place` of the population, and
    /// returns it with its factors `F` and `CR`.
    fn trial(&self, place: usize) -> (Vec<f64>, [f64; 2]) {
        let stream = &mut self.streams.at(self.generation, Phase::Mutation, place);
        let factors = self.factors(stream);
        let [f, crossover] = factors;
        let count = self.population.len();
        let leading = share(self.settings.best, count).max(2).min(count);
        let best = &self.population[stream.index(leading)].0;
        let first = other(stream, count, &[place]);
        let second = other(stream, count + self.replaced.len(), &[place, first]);
        let second = self
            .population
            .get(second)
            .map_or_else(|| &self.replaced[second - count], |(x, _)| x);
        let (own, first) = (&self.population[place].0, &self.population[first].0);
        let kept = stream.index(own.len());
        let axes = self.space.axes().iter().enumerate();
        let x = axes.map(|(k, axis)| {
            let crossed = stream.chance(crossover) || k == kept;
            if !crossed {
                return own[k];
            }
            let mutant = own[k] + f * (best[k] - own[k]) + f * (first[k] - second[k]);
            repair_bound(axis, own[k], mutant)
        });
        (x.collect(), factors)
    }

    /// Draws the factor `F` from a Cauchy distribution and the crossover rate `CR` from a normal one, both
    /// centred on a random slot of the memory.
    fn factors(&self, stream: &mut Stream) -> [f64; 2] {
        let [f, crossover] = self.memories[stream.index(self.memories.len())];
        let cauchy =
            |stream: &mut Stream| f + 0.1 * libm::tan(std::f64::consts::PI * (stream.unit() - 0.5));
        let mut drawn = cauchy(stream);
        while drawn <= 0.0 {
            drawn = cauchy(stream);
        }
        let crossover = (crossover + 0.1 * stream.normal()).clamp(0.0, 1.0);
        [drawn.min(1.0), crossover]
    }

    /// Overwrites the oldest memory slot with the means of the factors of successful trials, weighted by
    /// their fitness gains.
    fn learn(&mut self, gains: &[(f64, [f64; 2])]) {
        let total: f64 = gains.iter().map(|(gain, _)| gain).sum();
        if total <= 0.0 || !total.is_finite() {
            return;
        }
        let sum = |of: &dyn Fn([f64; 2]) -> f64| -> f64 {
            gains
                .iter()
                .map(|(gain, factors)| gain / total * of(*factors))
                .sum()
        };
        let f = sum(&|[f, _]| f * f) / sum(&|[f, _]| f);
        self.memories[self.oldest] = [f, sum(&|[_, crossover]| crossover)];
        self.oldest = (self.oldest + 1) % self.memories.len();
    }

    /// Returns the size that the population should have after the evaluations so far; it shrinks linearly.
    fn wanted(&self) -> usize {
        let first = self.settings.population;
        let spent = self.planned as f64 / self.settings.evaluations as f64;
        let lost = share(spent.min(1.0), first - FEWEST);
        first - lost
    }
}

fn share(share: f64, count: usize) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of a count"
    )]
    let part = (share * count as f64).round() as usize;
    part
}

/// Draws an index below `count` that is not in `taken`. Loops forever if every index is taken.
fn other(stream: &mut Stream, count: usize, taken: &[usize]) -> usize {
    loop {
        let one = stream.index(count);
        if !taken.contains(&one) {
            return one;
        }
    }
}

/// Repairs a mutant coordinate outside the bounds: halfway between its parent and the bound.
fn repair_bound(axis: &Axis, own: f64, mutant: f64) -> f64 {
    let interval = axis.interval();
    if mutant < interval.from {
        0.5 * (own + interval.from)
    } else if mutant > interval.to {
        0.5 * (own + interval.to)
    } else {
        mutant
    }
}

impl SearchStage for LShade {
    fn plan(&mut self, _archive: &Archive) -> Option<Batch> {
        let left = self.settings.evaluations.saturating_sub(self.planned);
        if left == 0 {
            return None;
        }
        let purpose = if self.population.is_empty() {
            self.trials = self.first(self.settings.population.min(left));
            Purpose::Initial
        } else {
            self.generation += 1;
            let count = self.population.len().min(left);
            self.trials = (0..count).map(|place| self.trial(place)).collect();
            Purpose::Offspring
        };
        self.planned += self.trials.len();
        let drafts = self.trials.iter().map(|(x, _)| ProposalDraft {
            genes: self.space.values(x),
            purpose,
        });
        Some(Batch {
            generation: self.generation,
            drafts: drafts.collect(),
        })
    }

    fn absorb(&mut self, results: &[EvaluatedIndividual]) {
        let trials = std::mem::take(&mut self.trials);
        let told = results.iter().map(|result| result.result);
        if self.population.is_empty() {
            let born = trials.into_iter().zip(told);
            self.population = born.map(|((x, _), told)| (x, told)).collect();
        } else {
            let mut gains = Vec::new();
            for ((own, (x, factors)), told) in self.population.iter_mut().zip(trials).zip(told) {
                if told.beats(own.1) {
                    let gain = own.1.fitness - told.fitness;
                    if gain > 0.0 && gain.is_finite() {
                        gains.push((gain, factors));
                    }
                    self.replaced.push(std::mem::replace(own, (x, told)).0);
                }
            }
            self.learn(&gains);
        }
        self.population.sort_by(|a, b| a.1.order(b.1));
        self.population.truncate(self.wanted().max(FEWEST));
        let most = share(self.settings.archive, self.population.len());
        let mut stream = self.streams.at(self.generation, Phase::Selection, 0);
        while self.replaced.len() > most {
            let one = stream.index(self.replaced.len());
            self.replaced.swap_remove(one);
        }
    }

    fn generations(&self) -> u32 {
        // the population falls evenly to its end
        let left = self.settings.evaluations.saturating_sub(self.planned);
        let mean = usize::midpoint(self.wanted(), FEWEST).max(1);
        self.generation + u32::try_from(left.div_ceil(mean)).unwrap_or(u32::MAX)
    }

    fn remaining(&self) -> u64 {
        let left = self.settings.evaluations.saturating_sub(self.planned);
        (left + self.trials.len()) as u64
    }
}
