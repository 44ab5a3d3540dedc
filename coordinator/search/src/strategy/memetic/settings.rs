//! Settings of the memetic algorithm: the paper's numbers, and every point its text leaves open.
use crate::strategy::{SettingsError, require};
use serde::{Deserialize, Serialize};

/// How genes become a chromosome.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Encoding {
    /// Plain binary numbers; the paper speaks of bits. Default.
    Binary,
    /// Gray code: neighbouring values differ in one bit.
    Gray,
    /// Real numbers: crossover exchanges whole genes, and a mutation adds a normal step of
    /// [`MemeticSettings::real_step`] of the interval.
    Real,
}

/// How a chromosome is spread over a gene's interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// Evenly in the logarithm: the recommended value is the centre, as the paper says. Default.
    Logarithmic,
    /// Evenly in the value: 90 % of the population starts in the highest decade.
    Linear,
}

/// Weight of an individual on the roulette wheel, when small fitness is good.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Roulette {
    /// 1 / f: independent of the unit of f. Default.
    Inverse,
    /// 1 / (1 + f).
    InversePlusOne,
    /// (largest f) - f.
    Difference,
    /// Linear in the rank: the best of n weighs n, the worst 1.
    Rank,
}

/// Crossover of two parents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Crossover {
    /// Every bit is exchanged with probability 1/2. Default.
    Uniform,
    /// Everything behind one random point is exchanged.
    OnePoint,
}

/// What the mutation probability counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MutationUnit {
    /// Every bit flips with this probability. Default.
    Bit,
    /// In every gene one random bit flips with this probability.
    Gene,
    /// In every individual one random bit flips with this probability.
    Individual,
}

/// The "special" uniform crossover of elite and partner in the first hill climb.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SpecialCrossover {
    /// A bit comes from the partner with probability 0.1 to 0.6, the more the population differs
    /// from its elite. Default.
    EliteBiased,
    /// A bit comes from either with probability 1/2.
    Even,
}

/// How many random bits the second hill climb flips.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FlippedBits {
    /// 1 to 4, the more the population differs from its elite. Default.
    Adaptive,
    /// Always this many.
    Fixed(usize),
}

/// Which reading of the paper's steps 6 to 8.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Climbers {
    /// A generation of selection, crossover and mutation; then the elite climbs. Default.
    Elite,
    /// Likewise, but every individual climbs: one trial of each kind against itself.
    All,
    /// To the letter: no other crossover or mutation; each selected individual starts one
    /// crossover trial (with the crossover probability) and one mutation trial (each bit with the
    /// mutation probability) against the running elite.
    Literal,
}

/// How trials of a climb follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Acceptance {
    /// Every trial starts from the winner of the one before. Default.
    First,
    /// All trials start from the same elite and the best one wins: another algorithm, two
    /// batches per generation.
    BestOfBatch,
}

/// Who lives on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Survival {
    /// The children, and the best parent in place of the worst child if no child is as good.
    /// Default.
    Generational,
    /// The best of parents and children together.
    Plus,
}

/// Settings of the memetic algorithm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MemeticSettings {
    /// Individuals per generation.
    pub population: usize,
    /// Most generations; the initial population counts only with `initial_counts`.
    pub generations: u32,
    /// Whether the initial population is the first of the generations; default no.
    pub initial_counts: bool,
    /// Fitness at or below which the search ends, if any.
    pub threshold: Option<f64>,
    /// Probability that a pair is crossed.
    pub crossover_probability: f64,
    /// Probability of a mutation per `mutation_unit`.
    pub mutation_probability: f64,
    /// Trials of the crossover-based hill climb per generation; the paper gives none.
    pub crossover_trials: usize,
    /// Trials of the mutation-based hill climb per generation.
    pub mutation_trials: usize,
    /// How genes become a chromosome.
    pub encoding: Encoding,
    /// Bits per gene, 2 to 30; 16 resolve 1.2e-4 decade of 8.
    pub bits_per_gene: u32,
    /// Standard deviation of a mutation of the real encoding, as a share of the interval.
    pub real_step: f64,
    /// How a chromosome is spread over a gene's interval.
    pub scale: Scale,
    /// Weight on the roulette wheel.
    pub roulette: Roulette,
    /// Crossover of two parents.
    pub crossover: Crossover,
    /// What the mutation probability counts.
    pub mutation_unit: MutationUnit,
    /// Crossover of the first hill climb.
    pub special_crossover: SpecialCrossover,
    /// Bits flipped by the second hill climb.
    pub flipped_bits: FlippedBits,
    /// Which reading of the paper's steps.
    pub climbers: Climbers,
    /// How trials of a climb follow each other.
    pub acceptance: Acceptance,
    /// Who lives on.
    pub survival: Survival,
    /// How many trials of a sequential climb are evaluated ahead, from the current elite; what
    /// follows the first success is discarded. None: all that remain. The elite's path has the
    /// same bits for every width; a wide one takes fewer steps, a narrow one fewer evaluations.
    pub speculation: Option<usize>,
    /// Whether an individual met before keeps its result instead of being simulated again, as
    /// the paper would; the same bits either way.
    pub reuse_clones: bool,
}

impl MemeticSettings {
    /// The paper's numbers with the default reading of everything else: at most 6,080
    /// evaluations without speculation.
    pub const fn paper() -> Self {
        Self {
            population: 80,
            generations: 60,
            initial_counts: false,
            threshold: None,
            crossover_probability: 0.9,
            mutation_probability: 0.05,
            crossover_trials: 10,
            mutation_trials: 10,
            encoding: Encoding::Binary,
            bits_per_gene: 16,
            real_step: 0.05,
            scale: Scale::Logarithmic,
            roulette: Roulette::Inverse,
            crossover: Crossover::Uniform,
            mutation_unit: MutationUnit::Bit,
            special_crossover: SpecialCrossover::EliteBiased,
            flipped_bits: FlippedBits::Adaptive,
            climbers: Climbers::Elite,
            acceptance: Acceptance::First,
            survival: Survival::Generational,
            speculation: None,
            reuse_clones: true,
        }
    }

    /// 40 + 40 trials at once: 9,680 evaluations in 121 batches of 80.
    pub const fn paper_batch() -> Self {
        Self {
            crossover_trials: 40,
            mutation_trials: 40,
            acceptance: Acceptance::BestOfBatch,
            ..Self::paper()
        }
    }

    /// Generations after the initial one.
    pub(super) const fn bred_generations(&self) -> u32 {
        if self.initial_counts {
            self.generations.saturating_sub(1)
        } else {
            self.generations
        }
    }

    /// # Errors
    /// If a setting lies outside its range.
    pub(super) fn check(&self) -> Result<(), SettingsError> {
        let share = |x: f64| (0.0..=1.0).contains(&x);
        require(
            self.population >= 2,
            "population",
            self.population as f64,
            "at least 2",
        )?;
        require(
            (2..=30).contains(&self.bits_per_gene),
            "bits_per_gene",
            f64::from(self.bits_per_gene),
            "2 to 30",
        )?;
        require(
            share(self.crossover_probability),
            "crossover_probability",
            self.crossover_probability,
            "0 to 1",
        )?;
        require(
            share(self.mutation_probability),
            "mutation_probability",
            self.mutation_probability,
            "0 to 1",
        )?;
        require(
            self.real_step > 0.0 && self.real_step <= 1.0,
            "real_step",
            self.real_step,
            "above 0, at most 1",
        )?;
        require(
            self.speculation != Some(0),
            "speculation",
            0.0,
            "at least 1",
        )
    }
}
