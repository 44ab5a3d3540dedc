//! Results in words: changes, their sizes, and deteriorations.
//!
//! States only what the data show; every sentence can be read on its own.
mod calibration;
mod change;
pub mod command;
mod ending;
mod gene;
mod name;

pub(super) use calibration::{
    absolute_worse, channels, complete_objective, headline, square_after, structure, warnings,
};
pub use ending::{failure, verdict};
pub(super) use gene::{at_bound, bound, seen};
pub use name::condition_name;
pub(super) use name::{
    calibrated, capitalised, channel_title, counted, headed, is_fitted, listed, lower,
    objective_heading,
};

/// Notice for cases whose records are synthetic.
pub(super) const SYNTHETIC: &str = "The records of this case are synthetic: they were \
    computed, not measured on a machine, and say nothing about how well a real one is met.";
