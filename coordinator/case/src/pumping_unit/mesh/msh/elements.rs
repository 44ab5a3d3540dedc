//! Reading of the elements of a mesh file, with a check of Gmsh's element types.
//!
//! Bricks of second order become 8-node bricks: their nodes beyond the corners are left out. Bricks with
//! incompatible modes bend without locking, so the second order is not needed; that its curved edges become
//! straight is measured ([`super::super::Mesh::straightened_m`]). Prisms are refused: as bricks of which two
//! corners are one they are five times too stiff in bending in the plane of their triangles.
use super::{
    kind::{Block, Shape, Type, known, of_lower_dimension},
    lines::Lines,
    sections::{Sections, Version},
};
use crate::error::{CaseError, damaged};
use protocol::pumping_unit::ElementKind;
use std::path::Path;

/// Remedy for a mesh with element types that are not allowed.
const ALLOWED: &str = "mesh all volumes with bricks (Mesh.RecombineAll = 1), or all with 10-node \
                       tetrahedra (gmsh -order 2, Mesh.ElementOrder = 2)";

/// Reads the elements of the file's version.
pub(super) fn read(lines: &mut Lines<'_>, sections: &mut Sections) -> Result<(), CaseError> {
    match sections.version {
        Version::V22 => flat(lines, sections)?,
        Version::V41 => blocks(lines, sections)?,
    }
    lines.end("$EndElements")
}

/// Reads the elements of MSH 4.1: blocks, each of one type and one geometric entity.
fn blocks(lines: &mut Lines<'_>, sections: &mut Sections) -> Result<(), CaseError> {
    let [blocks, _, _, _] = lines.integers::<4>()?;
    for _ in 0..blocks {
        let [dimension, entity, number, count] = lines.integers::<4>()?;
        let dimension = usize::try_from(dimension).unwrap_or(usize::MAX);
        if dimension < 2 {
            for _ in 0..count {
                lines.line()?;
            }
            continue;
        }
        let of = allowed(lines, number)?;
        let tags = sections.groups.get(&(dimension, entity));
        let names = tags.into_iter().flatten();
        let names = names.filter_map(|tag| sections.names.get(&(dimension, *tag)).cloned());
        let mut block = Block {
            line: lines.number(),
            of,
            groups: names.collect(),
            nodes: Vec::new(),
        };
        for _ in 0..count {
            let numbers = lines.numbers::<i64>(of.nodes + 1)?;
            block.push(lines, sections, &numbers[1..])?;
        }
        sections.blocks.push(block);
    }
    Ok(())
}

/// Reads the elements of MSH 2.2: one a line, with type, tags (first the physical group) and nodes.
fn flat(lines: &mut Lines<'_>, sections: &mut Sections) -> Result<(), CaseError> {
    let [count] = lines.integers::<1>()?;
    let mut last = (0, 0);
    for _ in 0..count {
        let numbers = lines.numbers::<i64>(3)?;
        let [_, number, tags] = [0, 1, 2].map(|at| numbers.get(at).copied().unwrap_or_default());
        if of_lower_dimension(number) {
            continue;
        }
        let of = allowed(lines, number)?;
        let tags = usize::try_from(tags).unwrap_or(usize::MAX);
        let physical = if tags > 0 { numbers.get(3) } else { None };
        let physical = physical.copied().unwrap_or_default();
        if sections.blocks.is_empty() || last != (number, physical) {
            let dimension = if matches!(of.shape, Shape::Quadrilateral | Shape::Triangle) {
                2
            } else {
                3
            };
            sections.blocks.push(Block {
                line: lines.number(),
                of,
                groups: sections
                    .names
                    .get(&(dimension, physical))
                    .cloned()
                    .into_iter()
                    .collect(),
                nodes: Vec::new(),
            });
            last = (number, physical);
        }
        let nodes = numbers
            .get(3_usize.saturating_add(tags)..)
            .unwrap_or_default();
        if let Some(mut block) = sections.blocks.pop() {
            block.push(lines, sections, nodes)?;
            sections.blocks.push(block);
        }
    }
    Ok(())
}

impl Block {
    /// Appends an element by the tags of its nodes.
    fn push(
        &mut self,
        lines: &Lines<'_>,
        sections: &Sections,
        tags: &[i64],
    ) -> Result<(), CaseError> {
        let wanted = self.of.nodes;
        let tags = tags.get(..wanted).ok_or_else(|| {
            lines.wrong(&format!(
                "{wanted} nodes are expected here, for {}",
                self.of.name
            ))
        })?;
        for tag in tags {
            let node = sections.index.get(tag);
            let node = node.ok_or_else(|| lines.wrong(&format!("node {tag} does not exist")))?;
            self.nodes.push(*node);
        }
        Ok(())
    }

    const fn is_volume(&self) -> bool {
        matches!(self.of.shape, Shape::Brick | Shape::Tetrahedron)
    }
}

fn allowed(lines: &Lines<'_>, number: i64) -> Result<Type, CaseError> {
    let of = known(number);
    match (of.shape, of.order) {
        (Shape::Other, _) => Err(lines.wrong_with(
            &format!(
                "element type {number}, {}; allowed: hexahedra (types 5, 12, 17), or 10-node tetrahedra \
                 (type 11); prisms lock beside hexahedra, and pyramids between both",
                of.name
            ),
            ALLOWED,
        )),
        (Shape::Tetrahedron, 1) => Err(linear(lines.path(), lines.number(), of.name)),
        _ => Ok(of),
    }
}

fn linear(path: &Path, line: usize, name: &str) -> CaseError {
    damaged(
        path,
        format!(
            "line {line}: {name}: tetrahedra of order 1 lock: a layer of them is five times too stiff \
             in bending"
        ),
        "mesh with order 2: gmsh -order 2, or Mesh.ElementOrder = 2; for tetrahedra of 10 nodes and \
         triangles of 6",
    )
}

/// Puts the elements of all blocks into the groups of the mesh, as elements of one kind.
///
/// # Errors
/// Returns an error for bricks beside tetrahedra, and for faces that are none of the volumes'.
pub(super) fn join(path: &Path, sections: &mut Sections) -> Result<(), CaseError> {
    let blocks = std::mem::take(&mut sections.blocks);
    let first = |wanted: &dyn Fn(Shape) -> bool| blocks.iter().find(|block| wanted(block.of.shape));
    let tetrahedra = first(&|shape| shape == Shape::Tetrahedron);
    let bricks = first(&|shape| shape == Shape::Brick);
    let mesh = &mut sections.mesh;
    mesh.kind = if tetrahedra.is_some() && bricks.is_none() {
        ElementKind::Tetrahedron
    } else {
        ElementKind::Hexahedron
    };
    for block in &blocks {
        let unfit = match block.of.shape {
            Shape::Brick | Shape::Quadrilateral => tetrahedra,
            Shape::Tetrahedron | Shape::Triangle => bricks,
            Shape::Other => None,
        };
        if let Some(other) = unfit {
            return Err(damaged(
                path,
                format!(
                    "line {}: {}, but line {} has {}: bricks and tetrahedra do not fit face to face",
                    block.line, block.of.name, other.line, other.of.name
                ),
                ALLOWED,
            ));
        }
        if block.of.shape == Shape::Triangle && block.of.order == 1 && tetrahedra.is_some() {
            return Err(linear(path, block.line, block.of.name));
        }
        for element in block.nodes.chunks_exact(block.of.nodes) {
            if let Some(off) = straightened_m(&mesh.nodes_m, block.of, element) {
                mesh.straightened_m = Some(mesh.straightened_m.unwrap_or(0.0).max(off));
            }
        }
        let groups = if block.is_volume() {
            &mut mesh.volumes
        } else {
            &mut mesh.surfaces
        };
        for group in &block.groups {
            let elements = groups.entry(group.clone()).or_default();
            for element in block.nodes.chunks_exact(block.of.nodes) {
                elements.extend(corners(block.of.shape, element));
            }
        }
    }
    Ok(())
}

/// Returns the nodes of an element that the mesh keeps: all of a tetrahedron and its face, the corners of
/// bricks and theirs.
fn corners(shape: Shape, element: &[usize]) -> &[usize] {
    let kept = match shape {
        Shape::Brick => 8,
        Shape::Quadrilateral => 4,
        Shape::Tetrahedron | Shape::Triangle | Shape::Other => element.len(),
    };
    element.get(..kept).unwrap_or(element)
}

/// Ends of the edges on which the nodes 8 to 19 of a brick lie.
const EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [0, 3],
    [0, 4],
    [1, 2],
    [1, 5],
    [2, 3],
    [2, 6],
    [3, 7],
    [4, 5],
    [4, 7],
    [5, 6],
    [6, 7],
];

/// Returns the largest distance of a mid-edge node that the mesh leaves out from the middle of its straight
/// edge \[m\]; `None` for an element of which nothing is left out.
fn straightened_m(nodes_m: &[[f64; 3]], of: Type, element: &[usize]) -> Option<f64> {
    if of.shape != Shape::Brick || of.order != 2 {
        return None;
    }
    let place = |at: usize| {
        let node = element.get(at).and_then(|node| nodes_m.get(*node));
        node.copied().unwrap_or_default()
    };
    let off = EDGES.iter().zip(8..).map(|(&[from, to], middle)| {
        let (from, to, middle) = (place(from), place(to), place(middle));
        let parts = [0, 1, 2].map(|axis| middle[axis] - 0.5 * (from[axis] + to[axis]));
        parts.iter().map(|x| x * x).sum::<f64>().sqrt()
    });
    Some(off.fold(0.0, f64::max))
}
