//! The stages of a diagnosis, in order: each plans experiments, absorbs what they show and hands on.
pub(crate) mod again;
pub mod basin;
pub mod challenge;
pub(crate) mod establish;
pub(crate) mod low_orders;
pub mod pair;
pub mod preflight;
pub mod recalibrate;
pub mod refit;
pub mod show;
pub mod suspect;
pub mod valley;
pub(crate) mod wander;
pub mod whereabouts;
pub mod worth;
