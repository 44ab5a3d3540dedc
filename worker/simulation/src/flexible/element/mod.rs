//! Finite element kinds of the flexible head, behind one interface.
//!
//! A kind is implemented by one file and one line of `ElementKind::law`. The module handles single elements
//! and knows no mesh.
mod face;
mod hexahedron;
mod integral;
mod interface;
mod kind;
mod steel;
#[cfg(test)]
mod tests;
mod tetrahedron;

pub(super) use face::{Crossing, Cut};
pub(super) use interface::Element;
pub use kind::ElementKind;
pub use steel::Steel;
