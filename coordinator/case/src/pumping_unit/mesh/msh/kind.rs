//! Element types of Gmsh, and elements as a file has them.

/// Shape of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Brick,
    Tetrahedron,
    Quadrilateral,
    Triangle,
    /// Element that a head cannot consist of.
    Other,
}

/// Element type of Gmsh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Type {
    pub(super) shape: Shape,
    /// Polynomial order of the element.
    pub(super) order: usize,
    /// Number of nodes of an element; 0 for a type that is refused.
    pub(super) nodes: usize,
    pub(super) name: &'static str,
}

/// Returns the element type of a Gmsh type number.
pub(super) const fn known(number: i64) -> Type {
    use Shape::{Brick, Other, Quadrilateral, Tetrahedron, Triangle};
    let (shape, order, nodes, name) = match number {
        2 => (Triangle, 1, 3, "3-node triangles"),
        3 => (Quadrilateral, 1, 4, "4-node quadrilaterals"),
        4 => (Tetrahedron, 1, 4, "4-node tetrahedra"),
        5 => (Brick, 1, 8, "8-node hexahedra"),
        6 => (Other, 1, 0, "6-node prisms"),
        7 | 14 | 19 => (Other, 0, 0, "pyramids"),
        9 => (Triangle, 2, 6, "6-node triangles"),
        10 => (Quadrilateral, 2, 9, "9-node quadrilaterals"),
        11 => (Tetrahedron, 2, 10, "10-node tetrahedra"),
        12 => (Brick, 2, 27, "27-node hexahedra"),
        13 => (Other, 2, 0, "18-node prisms"),
        16 => (Quadrilateral, 2, 8, "8-node quadrilaterals"),
        17 => (Brick, 2, 20, "20-node hexahedra"),
        18 => (Other, 2, 0, "15-node prisms"),
        _ => (Other, 0, 0, "elements of another type"),
    };
    Type {
        shape,
        order,
        nodes,
        name,
    }
}

/// Returns whether a Gmsh element type is a point or a line, which carry nothing.
pub(super) const fn of_lower_dimension(number: i64) -> bool {
    matches!(number, 1 | 8 | 15 | 26 | 27 | 28)
}

/// Elements of one type in the same groups, as the file has them.
#[derive(Debug)]
pub(super) struct Block {
    /// Line at which the first element, or the header of a block of MSH 4.1, stands.
    pub(super) line: usize,
    pub(super) of: Type,
    /// Names of the groups to which the elements belong.
    pub(super) groups: Vec<String>,
    /// Tag of each element in the file.
    pub(super) tags: Vec<i64>,
    /// Node indices, element after element.
    pub(super) nodes: Vec<usize>,
}
