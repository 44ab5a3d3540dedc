//! The back head's mesh: elements of one kind in named groups, and whether it is the head of the modes.
//!
//! Checking it takes some milliseconds, so every load reads it whole; nothing of it travels.
mod body;
mod msh;
mod origin;
mod volume;

pub use body::{Mesh, SURFACES, SYMMETRY, VOLUME};
pub use msh::read;
pub(super) use msh::read_hashed;
pub(super) use origin::{Origin, check_hash, check_mass, check_origin};
