//! Model of the machine: description, coordinate layout, forces, inertia, tangent matrix, and the extensions of
//! effects.
mod anchor;
pub mod chain;
pub mod contact;
pub(crate) mod cycle;
pub mod description;
pub(crate) mod extension;
pub(crate) mod force_buffers;
pub(crate) mod forces;
mod ideal;
pub(crate) mod individual;
pub mod kinematics;
pub mod layout;
mod links;
pub(crate) mod machine;
pub(crate) mod machine_state;
pub(crate) mod parallel_ropes;
pub mod pose;
pub(crate) mod ropes;
mod tangent;
#[cfg(test)]
pub(crate) mod tests;
mod valid;

pub use force_buffers::ForceBuffers;
pub use individual::{BackHeadLoads, RopeMachine};
pub use machine::Machine;
pub use machine_state::MachineState;
pub use ropes::Ropes;
pub use valid::InvalidDescription;
