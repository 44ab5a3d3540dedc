//! Element kinds that a mesh may consist of.
use super::interface::Element;
use super::{hexahedron::Hexahedron, tetrahedron::Tetrahedron};

/// Element kind of a mesh; all elements are of one kind, because the faces of bricks and tetrahedra do not
/// match and a mixed mesh would have cracks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ElementKind {
    /// 8-node bricks with incompatible modes; faces have 4 nodes.
    #[default]
    Hexahedron,
    /// 10-node quadratic tetrahedra with straight or curved edges; faces have 6 nodes.
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
