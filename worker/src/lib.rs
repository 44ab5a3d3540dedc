//! One machine that evaluates: takes jobs from the bus, simulates, returns outcomes.
pub mod convert;
pub mod handler;
