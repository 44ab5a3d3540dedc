//! The machine as a model: what it is made of, where its coordinates live, its forces, its
//! inertia and their tangent.
mod anchor;
pub mod chain;
pub mod contact;
pub mod description;
mod forces;
mod individual;
pub mod kinematics;
pub mod layout;
mod links;
mod machine;
pub mod pose;
pub(crate) mod strand;
mod tangent;
mod valid;

/// Most modes a head may have in a simulation.
pub(crate) const MAX_MODES: usize = 24;

pub use forces::Powers;
pub use individual::Individual;
pub use links::Instant;
pub(crate) use links::turned;
pub use machine::{Machine, Ropes, Scratch};
pub use valid::InvalidDescription;

#[cfg(test)]
pub(crate) mod tests;
