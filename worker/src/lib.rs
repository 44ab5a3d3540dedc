//! One machine that evaluates: takes jobs from the bus, simulates, returns outcomes.
pub mod handler;
