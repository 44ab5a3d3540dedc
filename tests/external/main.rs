//! Tests of user-supplied model programs, from import to result: PEST models compared with results of PEST++,
//! a Python program with an effect that the case initially omits, and programs that fail in every possible
//! way. The programs need only Python or a shell.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of a test suite: to panic is to fail the test"
)]
mod allowed;
mod bad;
mod bench;
mod field;
mod joint;
mod pest;
mod rig;
mod stranger;
