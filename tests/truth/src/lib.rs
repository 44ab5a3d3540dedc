//! Blind test suite: generates records of a machine with a hidden effect, seals the answers, and scores the
//! verdicts of a diagnosis.
//!
//! The machine is the case's drawing with other coefficients, another discretisation, another integrator and
//! other laws ([`law`]) than those of the program under test, observed through a complete measuring chain
//! ([`measuring_chain`]). The program under test receives files only: none of its code may depend on this crate, and
//! this crate does not know how a diagnosis works.
pub mod draw;
pub mod files;
pub mod interval;
pub mod law;
pub mod machine;
pub mod measuring_chain;
pub mod plan;
pub mod scoring;
#[cfg(test)]
mod scoring_tests;
pub mod seal;
pub mod searches;
pub mod suite;
pub mod table;
pub mod turn;
pub mod verdict;
