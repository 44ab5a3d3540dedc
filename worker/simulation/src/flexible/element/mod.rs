//! Kinds of finite elements: what the head asks of one, whatever its shape.
//!
//! A kind is one file and one line of `ElementKind::law`. Knows one element in its place, no mesh.
mod face;
mod hexahedron;
mod integral;
mod kind;
mod law;
mod steel;
#[cfg(test)]
mod tests;
mod tetrahedron;

pub(super) use face::{Crossing, Cut};
pub use kind::ElementKind;
pub(super) use law::Element;
pub use steel::Steel;
