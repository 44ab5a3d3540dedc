//! Search strategies, and their common interface.
//!
//! A strategy is a sequence of *stages*, its batch-wise parts (an initial design, a memetic search, a line
//! scan, a refinement), each of which plans one batch of points at a time; the [`Sequencer`] assigns ids to
//! the points, accepts the results in any order and passes them on in id order. One strategy needs no
//! batches: [`memetic::window`].
//!
//! # Adding a strategy
//! A new strategy takes one file here and one line in [`CATALOGUE`] (beside its `mod` line); [`random`] is
//! the smallest example. The file has the settings as a struct that implements [`StrategySettings`], the table of the
//! settings that can be set by name, and the [`Preset`] with the accuracy that tests may demand. `calibrate
//! --preset NAME --set KEY=VALUE`, its help, resuming, `report` and `export` then support it, and the tests
//! of the catalogue check the requirements on every search:
//! * its proposals depend on the space, the settings, the seed and the results in id order, never on the
//!   order of arrival: draw from [`crate::random::Streams`], whose numbers have addresses;
//! * it stays inside the bounds, and ends even if everything fails;
//! * before its end it estimates the total number of evaluations, within about a third.
//!
//! Stages run by the sequencer obey the first requirement by construction.
pub mod archive;
pub mod ask_tell;
mod catalogue;
pub mod cma_es;
mod covariance;
pub mod definition;
mod design;
mod evaluation_result;
#[cfg(test)]
mod expectations;
pub mod family;
pub mod l_shade;
pub mod levenberg;
pub mod memetic;
mod ordered_results;
mod outcome;
mod proposal;
pub mod random;
pub mod refine;
pub mod scan;
mod sequencer;
pub mod setting;
pub mod settings;
mod sobol;
pub mod stage;
pub mod staged;
mod table;
#[cfg(test)]
mod tests;

pub use archive::{Archive, EvaluatedIndividual, Residual};
pub use ask_tell::Strategy;
pub use catalogue::{CATALOGUE, build, preset};
pub use definition::{Preset, SearchPlan};
pub use design::latin_hypercube;
pub use evaluation_result::EvaluationResult;
pub use family::DescentEnd;
pub use outcome::{Best, Finish, Progress};
pub use proposal::{Proposal, Purpose};
pub use sequencer::Sequencer;
pub use setting::SettingsError;
pub use settings::{Settings, StrategySettings};
pub use stage::{Batch, ProposalDraft, SearchStage};
pub use table::build_after;
