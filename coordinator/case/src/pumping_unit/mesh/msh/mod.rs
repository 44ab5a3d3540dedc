//! Reader of Gmsh ASCII files of the versions 4.1 and 2.2: nodes, elements and their faces, physical groups.
//!
//! The crate `mshio` 0.4.2 is not used, for two reasons: it skips `$PhysicalNames` and the physical tags of
//! entities, without which pin holes cannot be identified, and it panics on a malformed node count. The tests
//! use it as a reference for nodes and elements.
mod elements;
mod kind;
mod lines;
mod reader;
mod sections;
#[cfg(test)]
mod tests;
mod whole;

pub use reader::read;
pub(in super::super) use reader::read_hashed;
