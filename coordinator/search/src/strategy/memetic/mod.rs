//! Memetic algorithm of the reference paper (sections 5.1 to 5.3): a genetic algorithm on bit strings with
//! hill climbing of the elite after every generation.
//!
//! Each point that the paper leaves open is a documented choice in [`MemeticSettings`]. [`generations`] is
//! the paper's algorithm, [`window`] the same operators without generations.
mod chromosome;
mod climb;
pub mod generations;
mod operators;
mod population;
mod roulette;
pub mod settings;
#[cfg(test)]
mod tests;
mod variation;
pub mod window;

pub use settings::{
    Acceptance, Climbers, CodeScale, Crossover, Encoding, MemeticSettings, MutationUnit, Roulette,
    SpecialCrossover, Survival,
};
