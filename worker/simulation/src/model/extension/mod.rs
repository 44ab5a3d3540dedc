//! Interfaces through which effects modify a machine: the kinds of extensions and the trait of an effect.
//!
//! A machine without effects has an empty set of extensions and computes the plain model. This module does not
//! depend on individual effects.
pub(crate) mod along;
pub(crate) mod axial;
pub(crate) mod effect;
pub(crate) mod force;
pub(crate) mod line;
pub(crate) mod profile;
pub(crate) mod reading;
pub(crate) mod set;

pub use along::LineForceValue;
pub use axial::{Axial, Memory, MemoryDerivatives, Strain};
pub use effect::{Effect, Site};
pub use force::Force;
pub(crate) use line::dry_friction;
pub use line::{Dashpot, LineForce};
pub use profile::Hollow;
pub use reading::{Reading, SampleState};
pub use set::Extensions;
