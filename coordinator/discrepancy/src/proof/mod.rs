//! Validation: how far the gap between simulation and record closes, on fitted and on held-out data. The
//! module knows no effect by name.
pub mod closed;
pub mod compare;
pub mod gap;
pub mod predictive;
pub(crate) mod scale;
