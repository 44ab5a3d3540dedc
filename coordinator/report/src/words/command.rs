//! Commands that reports recommend, with CASE for the case folder. A test of the command line parses each of
//! them.

/// Command that simulates a case.
pub const SIMULATE: &str = "horsehead simulate CASE";
/// Command that checks a case and its records.
pub const CHECK: &str = "horsehead case check CASE";
/// Command that calibrates as thoroughly as the reference paper.
pub const CALIBRATE: &str = "horsehead calibrate CASE --preset paper";

/// All recommended commands, for tests.
pub const ALL: [&str; 3] = [SIMULATE, CHECK, CALIBRATE];
