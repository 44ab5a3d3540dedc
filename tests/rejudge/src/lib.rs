//! Decisions of a diagnosis on a linearised model, without a simulation.
//!
//! A [`LinearModel`] holds the curves of a case at one point and their derivatives by every unknown and every
//! size of every effect. It answers the requests of [`discrepancy::diagnose::diagnose`] at once, so that
//! rates over hundreds of synthetic records ([`trial::Trial`]) take seconds to minutes: the same code decides as
//! on a real record, but laws are linear, so that rates are better than on the machine itself.
pub mod linear;
pub mod trial;

pub use linear::LinearModel;
