//! The machine as a model: what it is made of, where its coordinates live, its forces, its
//! inertia and their tangent.
pub mod contact;
pub mod description;
mod forces;
pub mod kinematics;
pub mod layout;
mod links;
mod machine;
pub mod pose;
mod tangent;

pub(crate) use forces::MAX_MODES;
pub use forces::Powers;
pub use links::{ChainLoads, Instant};
pub use machine::{InvalidDescription, Machine, Ropes, Scratch};

#[cfg(test)]
mod tests;
