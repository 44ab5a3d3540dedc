//! Reads Gmsh MSH 4.1, ASCII: nodes, elements and their faces, physical groups.
//!
//! The reader is our own, for two reasons found with the crate `mshio` 0.4.2: it skips
//! `$PhysicalNames` and the physical tags of entities, without which nothing says what a pin hole
//! is, and it panics on a malformed node count. It stays the judge of nodes and elements in the
//! tests.
mod elements;
mod lines;
mod reader;
mod sections;
#[cfg(test)]
mod tests;
mod whole;

pub use reader::read;
pub(in super::super) use reader::read_hashed;
