//! Commands that reports advise, with CASE for the folder of a case. A test of the command line parses
//! every one.

/// Simulates a case.
pub const SIMULATE: &str = "horsehead simulate CASE";
/// Checks a case and its records.
pub const CHECK: &str = "horsehead case check CASE";
/// Calibrates as thoroughly as the reference paper.
pub const CALIBRATE: &str = "horsehead calibrate CASE --preset paper";

/// All of them.
pub const ALL: [&str; 3] = [SIMULATE, CHECK, CALIBRATE];
