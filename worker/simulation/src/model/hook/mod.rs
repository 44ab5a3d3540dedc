//! Where effects take hold of a machine: the kinds of piece that one may hang there, and what an effect
//! is to the machine.
//!
//! A machine without effects has an empty set of pieces and computes what it always did. Nothing here
//! knows which effect a piece belongs to, nor what effects there are.
pub(crate) mod along;
pub(crate) mod axial;
pub(crate) mod effect;
pub(crate) mod force;
pub(crate) mod line;
pub(crate) mod profile;
pub(crate) mod reading;
pub(crate) mod set;

pub use along::Along;
pub use axial::{Axial, Memory, Strain};
pub use effect::{Effect, Site};
pub use force::Force;
pub(crate) use line::dry_friction;
pub use line::{Dashpot, LineForce};
pub use profile::Hollow;
pub use reading::{Reading, Sampled};
pub use set::Hooks;
