//! The strategies there are, and what they have in common.
//!
//! A strategy is a sequence of *pieces* (an initial design, a memetic search, a line scan, a
//! refinement), each of which plans one batch of points at a time; the [`Conductor`] gives the
//! points their ids, waits for the results in any order and hands them on in id order. One needs no
//! batches: [`memetic::window`]. A new strategy costs one file and one line in [`CATALOGUE`].
mod archive;
mod conductor;
mod design;
pub mod levenberg;
pub mod memetic;
pub mod quick;
pub mod refine;
pub mod scan;

pub use archive::{Archive, Evaluated};
pub use conductor::Conductor;
pub use design::latin_hypercube;

use crate::space::Space;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

/// A search for the individual of smallest fitness.
pub trait Strategy {
    /// Everything that can be evaluated now and has not been handed out before; ids are
    /// consecutive from 0 over the whole run. Empty while results are awaited, and at the end.
    fn ask(&mut self) -> Vec<Proposal>;

    /// Takes the result of a proposal. Results may come in any order: they are buffered and
    /// consumed in id order, so nothing ever depends on arrival. A result told twice is ignored.
    fn tell(&mut self, id: u64, result: Told);

    /// Takes the residual vector of a proposal whose purpose wants one, before its result: in units
    /// in which its squared length is the fitness.
    /// A strategy that wants none ignores it.
    fn tell_residual(&mut self, _id: u64, _residual: Vec<f64>) {}

    /// Why the search is over, if it is.
    fn finished(&self) -> Option<Finish>;

    /// How far it has come.
    fn progress(&self) -> Progress;

    /// The best individual so far: complete before failed, then by fitness, then by id.
    fn best(&self) -> Option<Best>;

    /// Every result that was consumed, in id order.
    fn archive(&self) -> &Archive;
}

/// An individual to evaluate.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// Consecutive from 0.
    pub id: u64,
    /// Gene values in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// The generation it belongs to; 0 is the initial one.
    pub generation: u32,
    /// What it is for.
    pub purpose: Purpose,
}

/// What a proposal is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Purpose {
    /// Member of the initial population.
    Initial,
    /// Child of two parents.
    Offspring,
    /// Trial of the crossover-based hill climb.
    CrossoverTrial,
    /// Trial of the mutation-based hill climb.
    MutationTrial,
    /// Station of a line scan.
    Scan,
    /// Step of a local refinement.
    Refinement,
    /// Column or step of a descent of the residual vector.
    LeastSquares,
}

impl Purpose {
    /// As written in tables and files.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Initial => "initial",
            Self::Offspring => "offspring",
            Self::CrossoverTrial => "crossover_trial",
            Self::MutationTrial => "mutation_trial",
            Self::Scan => "scan",
            Self::Refinement => "refinement",
            Self::LeastSquares => "least_squares",
        }
    }

    /// Whether the residual vector is wanted beside the fitness.
    pub const fn wants_residual(self) -> bool {
        matches!(self, Self::LeastSquares)
    }
}

/// The result of an evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Told {
    /// What is minimised; of an incomplete simulation a grade that says how far it got. Not a
    /// number counts as the worst failure.
    pub fitness: f64,
    /// Whether the simulation reached its end.
    pub complete: bool,
}

impl Told {
    /// Complete before failed, then by fitness; the smaller is the better. Not a number is last.
    pub fn order(self, other: Self) -> Ordering {
        let key = |told: Self| (!told.complete || told.fitness.is_nan(), told.fitness);
        let ((failed, fitness), (other_failed, other_fitness)) = (key(self), key(other));
        let by_number = || fitness.is_nan().cmp(&other_fitness.is_nan());
        failed
            .cmp(&other_failed)
            .then_with(by_number)
            .then_with(|| fitness.total_cmp(&other_fitness))
    }

    /// Strictly better than another.
    pub fn beats(self, other: Self) -> bool {
        self.order(other) == Ordering::Less
    }

    /// Complete and comparable: fit to be an elite.
    pub fn survived(self) -> bool {
        self.complete && !self.fitness.is_nan()
    }
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Finish {
    /// Everything that was planned has been evaluated.
    Planned,
    /// The fitness threshold was reached.
    Threshold,
}

/// How far a search has come.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// The current generation; 0 is the initial one.
    pub generation: u32,
    /// How many generations are planned.
    pub generations: u32,
    /// Results consumed, in id order.
    pub evaluations: u64,
    /// How many evaluations to expect in all: those so far and those still planned.
    pub expected_evaluations: u64,
    /// Fitness of the best complete individual.
    pub best_fitness: Option<f64>,
}

/// The best individual of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Best {
    /// Id of its proposal.
    pub id: u64,
    /// Gene values in declared units.
    pub genes: Vec<f64>,
    /// Its fitness.
    pub fitness: f64,
    /// False only if every individual failed.
    pub complete: bool,
}

impl From<&Evaluated> for Best {
    fn from(found: &Evaluated) -> Self {
        Self {
            id: found.id,
            genes: found.genes.clone(),
            fitness: found.told.fitness,
            complete: found.told.survived(),
        }
    }
}

/// One batch-wise part of a strategy. It sees results only as whole batches, in the order of its
/// own plan.
pub trait Piece {
    /// The next batch, or none when the piece is done; never an empty one. The archive holds
    /// every result of the run so far.
    fn plan(&mut self, archive: &Archive) -> Option<Batch>;

    /// Takes the results of the last batch: one per draft, in its order.
    fn absorb(&mut self, results: &[Evaluated]);

    /// How many generations it counts.
    fn generations(&self) -> u32;

    /// How many evaluations it still expects, the running batch included.
    fn remaining(&self) -> u64;

    /// Whether a result so good was found that the whole search ends.
    fn reached_threshold(&self) -> bool {
        false
    }
}

/// Points that can be evaluated at the same time.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// Generation, counted from the start of the piece.
    pub generation: u32,
    /// The points, with what they are for.
    pub drafts: Vec<Draft>,
}

/// A point to evaluate.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// Gene values in declared units.
    pub genes: Vec<f64>,
    /// What it is for.
    pub purpose: Purpose,
}

/// The settings of any strategy: with the space and a seed they decide a search to the last bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "strategy")]
pub enum Settings {
    /// The memetic algorithm of the reference paper.
    Memetic(memetic::MemeticSettings),
    /// A short memetic search with line scans and refinement.
    Quick(quick::QuickSettings),
    /// The memetic algorithm without generations.
    Window(memetic::window::WindowSettings),
}

/// Settings that no search can be made of.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// A setting lies outside its range.
    #[error("{setting} is {value}, but must be {allowed}")]
    Range {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        allowed: &'static str,
    },
}

impl Settings {
    /// The strategy over a space, from a seed.
    ///
    /// # Errors
    /// If a setting lies outside its range.
    pub fn build(&self, space: &Space, seed: u64) -> Result<Box<dyn Strategy>, SettingsError> {
        Ok(match self {
            Self::Memetic(settings) => Box::new(memetic::build(settings, space, seed)?),
            Self::Quick(settings) => Box::new(quick::build(settings, space, seed)?),
            Self::Window(settings) => Box::new(memetic::window::build(settings, space, seed)?),
        })
    }
}

/// A named choice of strategy and settings.
pub struct Preset {
    /// As given on the command line.
    pub name: &'static str,
    /// One line for help texts.
    pub summary: &'static str,
    /// The settings for a space.
    pub settings: fn(&Space) -> Settings,
}

/// Every preset, in the order in which help lists them.
pub const CATALOGUE: &[Preset] = &[
    Preset {
        name: "quick",
        summary: "a short memetic search, line scans of the axial stiffness, refinement",
        settings: |space| Settings::Quick(quick::QuickSettings::for_space(space)),
    },
    Preset {
        name: "least-squares",
        summary: "a short memetic search and line scans, then Levenberg-Marquardt on the residual",
        settings: |space| Settings::Quick(quick::QuickSettings::least_squares(space)),
    },
    Preset {
        name: "paper",
        summary: "the reference paper's memetic algorithm: 80 individuals, 60 generations",
        settings: |_| Settings::Memetic(memetic::MemeticSettings::paper()),
    },
    Preset {
        name: "paper-batch",
        summary: "the same with 40 + 40 climbing trials at once, the best of which wins",
        settings: |_| Settings::Memetic(memetic::MemeticSettings::paper_batch()),
    },
    Preset {
        name: "window",
        summary: "the same without generations: no worker waits, and the bits are still the same",
        settings: |_| Settings::Window(memetic::window::WindowSettings::for_workers(16)),
    },
];

/// The preset of a name.
pub fn preset(name: &str) -> Option<&'static Preset> {
    CATALOGUE.iter().find(|preset| preset.name == name)
}

/// Checks one setting against a condition.
pub(crate) fn require(
    holds: bool,
    setting: &'static str,
    value: f64,
    allowed: &'static str,
) -> Result<(), SettingsError> {
    if holds {
        Ok(())
    } else {
        Err(SettingsError::Range {
            setting,
            value,
            allowed,
        })
    }
}

#[cfg(test)]
mod tests;
