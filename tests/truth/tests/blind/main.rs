//! The blind suite's own tests: laws that are its own and yet those of their names, programs that know
//! nothing of it, and the whole way on a coarse machine, where records are made and sealed, diagnosed by
//! the program, and opened.
//!
//! That machine has ropes of 150 mm cylinders against a truth of 75 mm ones, and four times the noise of
//! the full suite, which hides what that difference leaves. To take seconds, the diagnosis starts from
//! Table 3's coefficients and considers a part of the library; the suite itself (README.md) does
//! neither. The programs are those that `cargo test --workspace` built.
mod alike;
mod apart;
mod coarse;
mod friction;
mod nothing;
mod practice;
