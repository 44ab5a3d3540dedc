//! Reading of the back head's mesh, with elements of one kind in named groups, and a check that the modes
//! belong to it.
//!
//! The check takes a few milliseconds, so every load reads the whole mesh; the mesh is not sent to workers.
mod body;
mod msh;
mod origin;
mod surface;
mod volume;

pub use body::{Mesh, SURFACES, SYMMETRY, VOLUME};
pub use msh::read;
pub(super) use msh::read_hashed;
pub(super) use origin::{Origin, check_hash, check_mass, check_origin, check_rim};
pub(super) use surface::surface_distances_m;
