//! The kinds of element that a mesh may be made of: one line each.
use super::law::Element;
use super::{hexahedron::Hexahedron, tetrahedron::Tetrahedron};

/// What a mesh is made of: one kind throughout. Bricks and tetrahedra do not fit face to face, so a
/// mesh of both would be cracked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ElementKind {
    /// Bricks of 8 nodes with incompatible modes; faces of 4 nodes.
    #[default]
    Hexahedron,
    /// Quadratic tetrahedra of 10 nodes, edges straight or curved; faces of 6 nodes.
    Tetrahedron,
}

impl ElementKind {
    pub(in crate::flexible) const fn law(self) -> &'static dyn Element {
        match self {
            Self::Hexahedron => &Hexahedron,
            Self::Tetrahedron => &Tetrahedron,
        }
    }
}
