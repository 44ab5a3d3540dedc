//! What the coordinator knows of the pumping unit, the model of the kind `dhh`. Everything else there
//! asks for it by the kind that a case names.
pub(crate) mod command;
mod digest;
mod head_comparison;
pub(crate) mod kind;
mod output;
pub mod report;

pub use digest::simulation_digest;
pub use head_comparison::{
    HalfRanges, HeadComparison, ModeMatch, WrappedTurn, compare_head, reduce_head, wrapped_turn,
};
