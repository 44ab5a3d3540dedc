//! The proof: how far the gap between simulation and record closes, on cycles that were fitted and on
//! those that were not. It knows no name.
pub mod closed;
pub mod compare;
pub mod gap;
pub mod predictive;
pub(crate) mod scale;
