//! Model of the machine: description, coordinate layout, forces, inertia, tangent matrix, and the extensions of
//! effects.
mod anchor;
pub mod chain;
pub mod contact;
pub(crate) mod cycle;
pub mod description;
pub(crate) mod extension;
pub(crate) mod forces;
mod ideal;
pub(crate) mod individual;
pub(crate) mod instant;
pub mod kinematics;
pub mod layout;
mod links;
pub(crate) mod machine;
pub mod pose;
pub(crate) mod ropes;
pub(crate) mod scratch;
pub(crate) mod strand;
mod tangent;
#[cfg(test)]
pub(crate) mod tests;
mod valid;

pub use individual::{BackHeadLoads, RopeMachine};
pub use instant::Instant;
pub use machine::Machine;
pub use ropes::Ropes;
pub use scratch::Scratch;
pub use valid::InvalidDescription;
