//! Reading of the elements of a mesh file, with a check of Gmsh's element types.
//!
//! Bricks of second order become 8-node bricks: their nodes beyond the corners are left out. Bricks with
//! incompatible modes bend without locking, so the second order is not needed; that its curved edges become
//! straight is measured ([`super::super::Mesh::straightened_m`]). Prisms are refused: as bricks of which two
//! corners are one they are five times too stiff in bending in the plane of their triangles.
use super::super::body::VOLUME;
use super::{
    kind::{Block, Shape, Type, known, of_lower_dimension},
    lines::Lines,
    sections::{Sections, Version},
};
use crate::error::{CaseError, damaged};
use nalgebra::Vector3;
use protocol::pumping_unit::ElementKind;
use std::{collections::HashSet, path::Path};

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
            tags: Vec::new(),
            nodes: Vec::new(),
        };
        for _ in 0..count {
            let numbers = lines.numbers::<i64>(of.nodes + 1)?;
            block.push(lines, sections, (numbers[0], &numbers[1..]))?;
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
        let [tag, number, tags] = [0, 1, 2].map(|at| numbers.get(at).copied().unwrap_or_default());
        if of_lower_dimension(number) {
            continue;
        }
        let of = allowed(lines, number)?;
        let tags = usize::try_from(tags).unwrap_or(usize::MAX);
        let physical = if tags > 0 { numbers.get(3) } else { None };
        let physical = physical.copied().unwrap_or_default().saturating_abs();
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
                tags: Vec::new(),
                nodes: Vec::new(),
            });
            last = (number, physical);
        }
        let nodes = numbers
            .get(3_usize.saturating_add(tags)..)
            .unwrap_or_default();
        if let Some(mut block) = sections.blocks.pop() {
            block.push(lines, sections, (tag, nodes))?;
            sections.blocks.push(block);
        }
    }
    Ok(())
}

impl Block {
    /// Appends an element by its tag and the tags of its nodes.
    fn push(
        &mut self,
        lines: &Lines<'_>,
        sections: &Sections,
        (tag, tags): (i64, &[i64]),
    ) -> Result<(), CaseError> {
        self.tags.push(tag);
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
/// Returns an error for bricks beside tetrahedra, for faces that are none of the volumes', for volumes outside the body,
/// and for second-order bricks whose nodes are in another order.
pub(super) fn join(path: &Path, sections: &mut Sections) -> Result<(), CaseError> {
    let blocks = std::mem::take(&mut sections.blocks);
    check_body(path, &blocks)?;
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
                if off.share > MOST_CURVED {
                    return Err(misplaced(path, block, off.share));
                }
                mesh.straightened_m = Some(mesh.straightened_m.unwrap_or(0.0).max(off.distance_m));
            }
        }
        // of the volumes, the body alone
        for group in &block.groups {
            let groups = match (block.is_volume(), group.as_str()) {
                (false, _) => &mut mesh.surfaces,
                (true, VOLUME) => {
                    sections.body.extend(&block.tags);
                    &mut mesh.volumes
                }
                (true, _) => continue,
            };
            let elements = groups.entry(group.clone()).or_default();
            for element in block.nodes.chunks_exact(block.of.nodes) {
                elements.extend(corners(block.of.shape, element));
            }
        }
    }
    Ok(())
}

/// Share of an edge's length by which its mid-edge node may lie beside it; more is another order of nodes.
const MOST_CURVED: f64 = 0.25;

fn misplaced(path: &Path, block: &Block, share: f64) -> CaseError {
    damaged(
        path,
        format!(
            "line {}: {}: a mid-edge node lies {:.0} % of the edge's length beside it: the nodes are not in Gmsh's \
             order",
            block.line,
            block.of.name,
            100.0 * share
        ),
        "let Gmsh write the file, or give the nodes in its order",
    )
}

/// Checks that every volume element belongs to the body, and once.
fn check_body(path: &Path, blocks: &[Block]) -> Result<(), CaseError> {
    let mut body = HashSet::new();
    let volumes = || blocks.iter().filter(|block| block.is_volume());
    let key = |element: &[usize]| {
        let mut nodes = element.to_vec();
        nodes.sort_unstable();
        nodes
    };
    let is_body = |block: &&Block| block.groups.iter().any(|group| group == VOLUME);
    for block in volumes().filter(is_body) {
        for element in block.nodes.chunks_exact(block.of.nodes) {
            if !body.insert(key(element)) {
                return Err(damaged(
                    path,
                    format!(
                        "line {}: an element of group `{VOLUME}` is defined twice, in the block that begins there",
                        block.line
                    ),
                    "remove duplicate elements (Gmsh: Mesh > Remove duplicate elements)",
                ));
            }
        }
    }
    let mut others = volumes().filter(|block| !is_body(block));
    let outside = others.find_map(|block| {
        let elements = block.nodes.chunks_exact(block.of.nodes);
        let outside = elements.filter(|element| !body.contains(&key(element)));
        Some((block, outside.count())).filter(|(_, count)| *count > 0)
    });
    match outside {
        // without any, the missing group is the fault
        Some((block, count)) if !body.is_empty() => Err(damaged(
            path,
            format!(
                "line {}: {count} volume elements of the block that begins there do not belong to group `{VOLUME}`{}",
                block.line,
                match block.groups.as_slice() {
                    [] => String::new(),
                    groups => format!(", but to {}", groups.join(", ")),
                }
            ),
            "put all volumes of the head into one physical group, steel, and mesh nothing else",
        )),
        _ => Ok(()),
    }
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

/// Distance of a mid-edge node from its straight edge.
#[derive(Clone, Copy, Debug, Default)]
struct Straightened {
    distance_m: f64,
    /// Share of the edge's length.
    share: f64,
}

/// Returns the largest distance of a mid-edge node that the mesh leaves out from the straight line through the ends of its
/// edge; `None` for an element of which nothing is left out.
fn straightened_m(nodes_m: &[[f64; 3]], of: Type, element: &[usize]) -> Option<Straightened> {
    if of.shape != Shape::Brick || of.order != 2 {
        return None;
    }
    let place = |at: usize| {
        let node = element.get(at).and_then(|node| nodes_m.get(*node));
        Vector3::from(node.copied().unwrap_or_default())
    };
    let off = EDGES.iter().zip(8..).map(|(&[from, to], middle)| {
        let (from, to, middle) = (place(from), place(to), place(middle));
        let edge = to - from;
        let length = edge.norm().max(f64::MIN_POSITIVE);
        let distance_m = edge.cross(&(middle - from)).norm() / length;
        let share = distance_m / length;
        Straightened { distance_m, share }
    });
    off.max_by(|a, b| a.distance_m.total_cmp(&b.distance_m))
}
