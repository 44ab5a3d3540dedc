//! Models that are programs of somebody's own, from the files that they come with to an answer: PEST's models beside
//! what PEST++ found, a Python program with an effect that the case starts without, and programs that do everything
//! wrong. The programs are Python's or the shell's; nothing else is installed.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of a test suite: to panic is to fail the test"
)]
mod allowed;
mod bad;
mod bench;
mod joint;
mod pest;
mod rig;
