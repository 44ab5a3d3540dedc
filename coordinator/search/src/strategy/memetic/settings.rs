//! Settings of the memetic algorithm: the paper's numbers, and every point that the paper leaves open.
use crate::strategy::setting::{AllowedValues, Setting, SettingsError, check, settings};
use serde::{Deserialize, Serialize};

/// Encoding of genes in a chromosome.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Encoding {
    /// Plain binary numbers; the paper speaks of bits. Default.
    Binary,
    /// Gray code, in which neighbouring gene values differ in one bit.
    Gray,
    /// Real numbers: crossover exchanges whole genes, and a mutation adds a normal step of
    /// [`MemeticSettings::real_step`] of the interval.
    Real,
}

/// Scale on which the codes of a gene are evenly spaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CodeScale {
    /// Logarithmic scale, on which the recommended value is the centre, as the paper says. Default.
    Logarithmic,
    /// Linear scale, on which 90 % of the initial population lies in the highest decade.
    Linear,
}

/// Weight of an individual on the roulette wheel; smaller fitness is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Roulette {
    /// Weight 1 / f, with f the fitness; selection does not depend on the unit of f. Default.
    Inverse,
    /// Weight 1 / (1 + f), with f the fitness.
    InversePlusOne,
    /// Weight (largest f in the population) - f, with f the fitness.
    Difference,
    /// Weight linear in the rank: the best of n individuals weighs n, the worst 1.
    Rank,
}

/// Crossover of two parents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Crossover {
    /// Exchange of every bit with probability 1/2. Default.
    Uniform,
    /// Exchange of all bits after one random point.
    OnePoint,
}

/// Unit (bit, gene or individual) to which the mutation probability applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MutationUnit {
    /// Mutation that flips every bit with the mutation probability. Default.
    Bit,
    /// Mutation that flips one random bit of every gene with the mutation probability.
    Gene,
    /// Mutation that flips one random bit of every individual with the mutation probability.
    Individual,
}

/// The "special" uniform crossover of elite and partner in the first hill climb.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SpecialCrossover {
    /// A bit comes from the partner with probability 0.1 to 0.6, the more the population differs
    /// from its elite. Default.
    EliteBiased,
    /// A bit comes from the elite or the partner with probability 1/2 each.
    Even,
}

/// Interpretation of the paper's steps 6 to 8: which individuals climb, and from which offspring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Climbers {
    /// Hill climbing of the elite only, after a generation of selection, crossover and mutation. Default.
    Elite,
    /// One hill-climbing trial of each kind for every individual, compared with that individual, after a
    /// generation of selection, crossover and mutation.
    All,
    /// The paper's literal text: no other crossover or mutation; each selected individual starts one
    /// crossover trial (with the crossover probability) and one mutation trial (each bit with the mutation
    /// probability) against the current elite.
    Literal,
}

/// Acceptance rule of a hill climb, which sets the order of its trials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Acceptance {
    /// Sequential hill climb: every trial starts from the winner of the previous trial. Default.
    First,
    /// Hill climb in batches: all trials start from the same elite and the best trial wins, a different
    /// algorithm with two batches per generation.
    BestOfBatch,
}

/// Survivor selection: the individuals that form the next generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Survival {
    /// All children, with the best parent in place of the worst child if no child is as good. Default.
    Generational,
    /// Best individuals of parents and children together (plus selection).
    Plus,
}

settings! {
    /// Settings of the memetic algorithm, also for the points that the paper leaves open.
    pub struct MemeticSettings, pub(in crate::strategy) table SETTINGS {
        pub population: usize = "individuals per generation", AllowedValues::Whole(4, 100_000);
        pub generations: u32 = "maximum number of generations", AllowedValues::Whole(0, 1_000_000);
        pub initial_counts: bool =
            "whether the initial population is the first of the generations",
            AllowedValues::Switch;
        pub threshold: Option<f64> =
            "fitness at or below which the search ends",
            AllowedValues::Real(0.0, f64::MAX), optional("none");
        pub crossover_probability: f64 = "probability that a pair is crossed", AllowedValues::Real(0.0, 1.0);
        pub mutation_probability: f64 = "probability of a mutation per mutation_unit", AllowedValues::Real(0.0, 1.0);
        pub crossover_trials: usize =
            "trials of the crossover-based hill climb per generation",
            AllowedValues::Whole(0, 1_000_000);
        pub mutation_trials: usize =
            "trials of the mutation-based hill climb per generation",
            AllowedValues::Whole(0, 1_000_000);
        pub encoding: Encoding =
            "encoding of genes in a chromosome",
            AllowedValues::Words(&["binary", "gray", "real"]);
        pub bits_per_gene: u32 = "bits per gene of the binary and Gray encodings", AllowedValues::Whole(2, 30);
        pub real_step: f64 =
            "deviation of a mutation of the real encoding, as a share of the interval",
            AllowedValues::Real(1e-6, 1.0);
        pub scale: CodeScale =
            "distribution of the codes over a gene's interval",
            AllowedValues::Words(&["logarithmic", "linear"]);
        pub roulette: Roulette =
            "weight on the roulette wheel: 1/f, 1/(1+f), largest f - f, by rank",
            AllowedValues::Words(&["inverse", "inverse_plus_one", "difference", "rank"]);
        pub crossover: Crossover = "crossover of two parents", AllowedValues::Words(&["uniform", "one_point"]);
        pub mutation_unit: MutationUnit =
            "unit to which mutation_probability applies",
            AllowedValues::Words(&["bit", "gene", "individual"]);
        pub special_crossover: SpecialCrossover =
            "share of the partner in the first hill climb: 0.1 to 0.6 by diversity, or half",
            AllowedValues::Words(&["elite_biased", "even"]);
        /// Number of random bits that the second hill climb flips; `None`, the default: 1 to 4, more in a more
        /// diverse population.
        pub flipped_bits: Option<usize> =
            "random bits that the second hill climb flips: 1 to 4 by diversity, or a fixed number",
            AllowedValues::Whole(1, 1000), optional("adaptive");
        /// Interpretation of the paper's steps 6 to 8: which individuals climb, and against which individual they
        /// are compared.
        pub climbers: Climbers =
            "individuals that climb: the elite, all, or the paper's literal steps",
            AllowedValues::Words(&["elite", "all", "literal"]);
        pub acceptance: Acceptance =
            "start of a trial: the last winner, or one elite for the whole batch",
            AllowedValues::Words(&["first", "best_of_batch"]);
        pub survival: Survival =
            "survivors: children and one elite, or the best of parents and children",
            AllowedValues::Words(&["generational", "plus"]);
        /// Number of trials of a sequential climb that are evaluated ahead, from the current elite; trials after
        /// the first success are discarded. `None`: all remaining trials. The elite's path is identical, bit for
        /// bit, for every value; a large value takes fewer batches, a small one fewer evaluations.
        pub speculation: Option<usize> =
            "trials evaluated ahead; same result, fewer batches and more evaluations the more there are",
            AllowedValues::Whole(1, 1_000_000), optional("all");
        /// Whether a repeated individual keeps its result instead of being simulated again, as the paper would;
        /// the search is identical, bit for bit, either way.
        pub reuse_clones: bool =
            "whether a repeated individual reuses its result; the search is the same either way",
            AllowedValues::Switch;
    }
}

impl MemeticSettings {
    /// Returns the paper's settings, with the default choice for everything the paper leaves open: at most
    /// 6,080 evaluations without speculation.
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
            scale: CodeScale::Logarithmic,
            roulette: Roulette::Inverse,
            crossover: Crossover::Uniform,
            mutation_unit: MutationUnit::Bit,
            special_crossover: SpecialCrossover::EliteBiased,
            flipped_bits: None,
            climbers: Climbers::Elite,
            acceptance: Acceptance::First,
            survival: Survival::Generational,
            speculation: None,
            reuse_clones: true,
        }
    }

    /// Returns the paper's settings with batches of 40 + 40 trials: 9,680 evaluations in 121 batches of 80.
    pub const fn paper_batch() -> Self {
        Self {
            crossover_trials: 40,
            mutation_trials: 40,
            acceptance: Acceptance::BestOfBatch,
            ..Self::paper()
        }
    }

    pub(super) const fn bred_generations(&self) -> u32 {
        if self.initial_counts {
            self.generations.saturating_sub(1)
        } else {
            self.generations
        }
    }

    pub(super) fn check(&self) -> Result<(), SettingsError> {
        check(self, SETTINGS)
    }
}
