//! Sentences and phrases on results: changes, their sizes, and deteriorations.
//!
//! States only what the data show; every sentence can be read on its own.
mod calibration;
mod change;
pub mod command;
mod gene;
mod name;
mod outcome;

pub(super) use calibration::{
    absolute_worse, agreement, channels, complete_objective, headline, lacks_intervals,
    model_error, no_intervals, noise_level, rivals, warnings,
};
pub use calibration::{intervals, square_after};
pub(super) use gene::{at_bound, bound, interval_cell};
pub(super) use name::{
    abscissa_quantity, calibrated, channel_title, is_fitted, join_words, lower, objective_heading,
    with_unit,
};
pub use name::{capitalised, condition_name};
pub use outcome::{failure, verdict};

/// Notice for cases whose records are synthetic.
pub(super) const SYNTHETIC: &str = "The records of this case are synthetic: they were \
    computed, not measured on a machine, and say nothing about how well a real one is met.";
