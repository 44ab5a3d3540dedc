//! Validation: how far the gap between simulation and record closes, on fitted and on held-out data. The
//! module knows no effect by name.
pub mod compare;
pub mod gap;
pub mod gap_closure;
pub mod predictive;
pub(crate) mod scoring_metric;
