//! From a case, as it travels, to a machine as the dynamics take it, and back: the only folder that
//! names both vocabularies. Degrees become radians and megapascals pascals here.
pub mod effect;
mod genes;
mod head;
mod machine;
mod refinement;
mod reply;
mod run;
mod twins;

pub use genes::rope_law;
pub(crate) use machine::no_condition;
pub use machine::{machine, machine_with};
pub use refinement::refined;
pub use reply::{counters, verdict};
pub use run::{discretised_settings, run_settings};
