//! Tests of the blind suite itself: hidden effects resemble those of the same name in the library, the
//! programs under test contain nothing of the suite, and the complete procedure (make, seal, diagnose, open)
//! works on a coarse machine.
//!
//! The coarse case has cylinders of 150 mm against 75 mm in the truth simulation, and four times the noise of
//! the full suite, which masks the discretisation error. To be quick, the diagnosis starts from Table 3's
//! coefficients and considers part of the library; the suite itself (README.md) does neither. The programs
//! are those that `cargo test --workspace` built.
mod alike;
mod apart;
mod coarse;
mod friction;
mod nothing;
mod practice;
mod raw;
