//! Memetic algorithm of the reference paper (sections 5.1 to 5.3): a genetic algorithm on bit strings with
//! hill climbing of the elite after every generation.
//!
//! Each point that the paper leaves open is a documented choice in [`MemeticSettings`]. [`generations`] is
//! the paper's algorithm, [`window`] the same operators without generations.
mod chromosome;
mod climb;
mod craft;
pub mod generations;
mod population;
pub mod settings;
#[cfg(test)]
mod tests;
mod variation;
mod wheel;
pub mod window;

pub use settings::{
    Acceptance, Climbers, Crossover, Encoding, MemeticSettings, MutationUnit, Roulette, Scale,
    SpecialCrossover, Survival,
};
