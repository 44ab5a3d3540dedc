//! Reading of the elements of a mesh file, with a check of Gmsh's element types.
use super::{lines::Lines, sections::Sections};
use crate::error::CaseError;
use protocol::pumping_unit::ElementKind;
use std::collections::BTreeMap;

/// Remedy for a mesh with element types that are not allowed.
const ALLOWED: &str = "mesh all volumes alike: 8-node hexahedra of order 1, or 10-node tetrahedra \
                       (gmsh -order 2, Mesh.ElementOrder = 2)";

/// Element kind that a Gmsh element type number stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Type {
    /// Volume elements of an allowed kind.
    Volume(ElementKind),
    /// Faces of volume elements of an allowed kind.
    Face(ElementKind),
    /// First-order tetrahedra, or their faces, which are refused.
    Linear,
    Other,
}

/// Returns the element kind and the name of a Gmsh element type number.
const fn known(number: i64) -> (Type, &'static str) {
    match number {
        2 => (Type::Linear, "3-node triangles"),
        3 => (Type::Face(ElementKind::Hexahedron), "4-node quadrilaterals"),
        4 => (Type::Linear, "4-node tetrahedra"),
        5 => (Type::Volume(ElementKind::Hexahedron), "8-node hexahedra"),
        6 => (Type::Other, "6-node prisms"),
        7 => (Type::Other, "5-node pyramids"),
        9 => (Type::Face(ElementKind::Tetrahedron), "6-node triangles"),
        10 => (Type::Other, "9-node quadrilaterals"),
        11 => (Type::Volume(ElementKind::Tetrahedron), "10-node tetrahedra"),
        12 => (Type::Other, "27-node hexahedra"),
        16 => (Type::Other, "8-node quadrilaterals"),
        17 => (Type::Other, "20-node hexahedra"),
        _ => (Type::Other, "elements of another type"),
    }
}

/// Reads the blocks of elements, each of one type and one geometric entity.
pub(super) fn read(lines: &mut Lines<'_>, sections: &mut Sections) -> Result<(), CaseError> {
    let [blocks, _, _, _] = lines.integers::<4>()?;
    // what the mesh consists of, and which line said so first
    let mut first: Option<(ElementKind, usize, &str)> = None;
    for _ in 0..blocks {
        let [dimension, entity, number, count] = lines.integers::<4>()?;
        let dimension = usize::try_from(dimension).unwrap_or(usize::MAX);
        // points and lines of the geometry carry nothing
        if dimension < 2 {
            for _ in 0..count {
                lines.line()?;
            }
            continue;
        }
        let (of, name) = known(number);
        let mesh = &mut sections.mesh;
        let (kind, nodes, groups) = match of {
            Type::Volume(kind) => (kind, kind.nodes(), &mut mesh.volumes),
            Type::Face(kind) => (kind, kind.face_nodes(), &mut mesh.surfaces),
            Type::Linear | Type::Other => return Err(refused(lines, of, (number, name))),
        };
        let (expected, line, other) = *first.get_or_insert((kind, lines.number(), name));
        if kind != expected {
            let problem = format!(
                "{name}, but line {line} has {other}: bricks and tetrahedra do not fit face to face"
            );
            return Err(lines.wrong_with(&problem, ALLOWED));
        }
        mesh.kind = kind;
        let read = block(lines, count, nodes, &sections.index)?;
        let tags = sections.groups.get(&(dimension, entity));
        for tag in tags.into_iter().flatten() {
            if let Some(group) = sections.names.get(&(dimension, *tag)) {
                groups.entry(group.clone()).or_default().extend(&read);
            }
        }
    }
    lines.end("$EndElements")
}

fn refused(lines: &Lines<'_>, of: Type, (number, name): (i64, &str)) -> CaseError {
    if of == Type::Linear {
        let problem = format!(
            "element type {number}, {name}: tetrahedra of order 1 lock: a layer of them is five \
             times too stiff in bending"
        );
        let help = "mesh with order 2: gmsh -order 2, or Mesh.ElementOrder = 2; for tetrahedra of \
                    10 nodes and triangles of 6";
        return lines.wrong_with(&problem, help);
    }
    let problem = format!(
        "element type {number}, {name}; allowed: 5 (8-node hexahedron) with 3 (4-node \
         quadrilateral), or 11 (10-node tetrahedron) with 9 (6-node triangle)"
    );
    lines.wrong_with(&problem, ALLOWED)
}

/// Reads `count` elements, each a tag followed by its node tags; returns the node indices.
fn block(
    lines: &mut Lines<'_>,
    count: i64,
    nodes: usize,
    index: &BTreeMap<i64, usize>,
) -> Result<Vec<usize>, CaseError> {
    let mut elements = Vec::new();
    for _ in 0..count {
        let numbers = lines.numbers::<i64>(nodes + 1)?;
        for tag in numbers.iter().skip(1).take(nodes) {
            let node = index.get(tag);
            elements.push(*node.ok_or_else(|| lines.wrong(&format!("node {tag} does not exist")))?);
        }
    }
    Ok(elements)
}
