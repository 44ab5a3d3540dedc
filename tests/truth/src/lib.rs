//! The blind suite: test records of a machine that hides an effect, sealed answers, and what verdicts
//! about them are worth.
//!
//! The machine is the case's drawing with other coefficients, another discretisation, another
//! integrator and other laws ([`law`]) than those of the program that is judged, read by a whole
//! measuring chain ([`chain`]). That program gets files and nothing else: nothing of it may depend on
//! this crate. Nothing here knows how a diagnosis works.
pub mod chain;
pub mod draw;
pub mod files;
pub mod interval;
pub mod judge;
#[cfg(test)]
mod judged;
pub mod law;
pub mod machine;
pub mod plan;
pub mod seal;
pub mod searches;
pub mod suite;
pub mod table;
pub mod turn;
pub mod verdict;
