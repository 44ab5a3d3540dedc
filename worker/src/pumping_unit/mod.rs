//! Pumping unit with double horse heads: conversion between the types of the protocol and of the simulation.
//!
//! This is the only folder that uses both sets of types; degrees become radians and megapascals pascals here.
mod columns;
mod completed_run;
mod curves;
mod digest;
mod effect;
mod genes;
mod head;
mod machine;
mod machines;
mod reduce_head;
mod refinement;
mod reply;
mod run;
mod simulator;
mod twins;

pub use genes::rope_law;
pub use machine::{machine, machine_with};
pub use refinement::refined;
pub use run::run_settings;
pub use simulator::PumpingUnits;
