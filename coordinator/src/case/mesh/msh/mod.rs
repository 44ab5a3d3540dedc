//! Reads Gmsh MSH 4.1, ASCII: nodes, elements and their faces, physical groups.
//!
//! The reader is our own, for two reasons found with the crate `mshio` 0.4.2: it skips
//! `$PhysicalNames` and the physical tags of entities, without which nothing says what a pin hole
//! is, and it panics on a malformed node count. It stays the judge of nodes and elements in the
//! tests.
mod elements;
mod lines;
#[cfg(test)]
mod tests;

use super::{
    super::{
        error::{CaseError, damaged},
        file,
        table::clip,
    },
    Mesh, SURFACES, SYMMETRY, VOLUME,
};
use lines::Lines;
use std::{collections::BTreeMap, path::Path};

/// What to do about a mesh that cannot be read.
const SAVE_AGAIN: &str = "save the mesh again as MSH 4.1 ASCII (gmsh -format msh41), \
                          8-node hexahedra of order 1 or 10-node tetrahedra";

/// Reads a mesh.
///
/// # Errors
/// Another version or a binary file, malformed sections (with the line), elements that are not taken
/// or of two kinds, a missing physical group, a group with a node that no element has, an element that
/// is inside out, a half that is none.
pub fn read(path: &Path) -> Result<Mesh, CaseError> {
    read_hashed(path).map(|(mesh, _)| mesh)
}

/// Reads a mesh, and names its content by its BLAKE3 hash in hexadecimal digits.
pub(in super::super) fn read_hashed(path: &Path) -> Result<(Mesh, String), CaseError> {
    let bytes = file::read(path, "the mesh of the back head, `flexible_head.mesh_file`")?;
    let hash = blake3::hash(&bytes).to_hex().to_string();
    Ok((parse(path, bytes)?, hash))
}

fn parse(path: &Path, bytes: Vec<u8>) -> Result<Mesh, CaseError> {
    check_version(path, &bytes)?;
    let text = file::text(path, bytes)?;
    let mut sections = Sections::default();
    let mut lines = Lines::new(path, &text);
    while let Some(line) = lines.next() {
        match line.trim() {
            "" => {}
            "$PhysicalNames" => sections.names = physical_names(&mut lines)?,
            "$Entities" => sections.groups = entities(&mut lines)?,
            "$Nodes" => nodes(&mut lines, &mut sections)?,
            "$Elements" => elements::read(&mut lines, &mut sections)?,
            other => skip(&mut lines, other)?,
        }
    }
    for wanted in SURFACES {
        require(
            path,
            &sections,
            wanted,
            sections.mesh.surfaces.get(wanted).map_or(0, Vec::len),
        )?;
    }
    require(
        path,
        &sections,
        VOLUME,
        sections.mesh.volumes.get(VOLUME).map_or(0, Vec::len),
    )?;
    let mut mesh = only_used(path, sections.mesh)?;
    for (group, elements) in &mesh.volumes {
        let inverted = |element: &[usize]| mesh.element_volume_m3(element).is_none();
        let mut elements = elements.chunks_exact(mesh.kind.nodes());
        if let Some(at) = elements.position(inverted) {
            return Err(damaged(
                path,
                format!(
                    "element {} of group `{group}` is inside out or has no volume",
                    at + 1
                ),
                "correct the node order of the element or the position of its nodes",
            ));
        }
    }
    mesh.half = mesh.surfaces.contains_key(SYMMETRY);
    check_half(path, &mesh)?;
    Ok(mesh)
}

/// Without nodes that no element has, such as the centres of arcs: nothing would hold them. The order
/// of the others is kept.
fn only_used(path: &Path, mut mesh: Mesh) -> Result<Mesh, CaseError> {
    let mut place = vec![None; mesh.nodes_m.len()];
    for node in mesh.volumes.values().flatten() {
        if let Some(place) = place.get_mut(*node) {
            *place = Some(0);
        }
    }
    for (index, place) in place.iter_mut().flatten().enumerate() {
        *place = index;
    }
    let moved = |node: &usize| place.get(*node).copied().flatten();
    for (group, faces) in &mut mesh.surfaces {
        for node in faces {
            *node = moved(node).ok_or_else(|| {
                let [x, y, z] = mesh.nodes_m.get(*node).copied().unwrap_or_default();
                damaged(
                    path,
                    format!(
                        "group `{group}` has a node at ({x:.4}, {y:.4}, {z:.4}) m that no element of the \
                         body has"
                    ),
                    "put only faces of the meshed body into the group",
                )
            })?;
        }
    }
    for node in mesh.volumes.values_mut().flatten() {
        *node = moved(node).unwrap_or_default();
    }
    let nodes = mesh.nodes_m.iter().zip(&place);
    mesh.nodes_m = nodes.filter_map(|(at, place)| place.map(|_| *at)).collect();
    Ok(mesh)
}

/// A half ends on the plane z = 0, and nothing of it lies beyond.
fn check_half(path: &Path, mesh: &Mesh) -> Result<(), CaseError> {
    const NEAR_M: f64 = 1e-6;
    let wrong = |[x, y, z]: &[f64; 3], problem: &str| {
        Err(damaged(
            path,
            format!("the node at ({x:.4}, {y:.4}, {z:.4}) m {problem}"),
            "cut the body at z = 0, mesh the side z >= 0 alone, and name the cut face symmetry",
        ))
    };
    let cut = mesh.surfaces.get(SYMMETRY);
    let mut cut = cut
        .into_iter()
        .flatten()
        .filter_map(|&node| mesh.nodes_m.get(node));
    if let Some(node) = cut.find(|[_, _, z]| z.abs() > NEAR_M) {
        return wrong(
            node,
            "belongs to group `symmetry`, which must lie in the plane z = 0",
        );
    }
    let beyond = mesh.nodes_m.iter().find(|[_, _, z]| *z < -NEAR_M);
    match beyond {
        Some(node) if mesh.half => wrong(
            node,
            "lies beyond the plane z = 0: a mesh with a group `symmetry` is the half z >= 0",
        ),
        _ => Ok(()),
    }
}

/// What has been read so far.
#[derive(Debug, Default)]
struct Sections {
    /// (dimension, physical tag) to group name.
    names: BTreeMap<(usize, i64), String>,
    /// (dimension, entity tag) to physical tags.
    groups: BTreeMap<(usize, i64), Vec<i64>>,
    /// Node tag to index.
    index: BTreeMap<i64, usize>,
    mesh: Mesh,
}

/// The format line, before the bytes are taken for text.
fn check_version(path: &Path, bytes: &[u8]) -> Result<(), CaseError> {
    let head = String::from_utf8_lossy(bytes.get(..bytes.len().min(200)).unwrap_or_default());
    let mut lines = head.lines();
    if lines.next().map(str::trim) != Some("$MeshFormat") {
        return Err(damaged(
            path,
            "line 1 is not `$MeshFormat`: the file is not a Gmsh mesh",
            SAVE_AGAIN,
        ));
    }
    let format = lines.next().unwrap_or_default().trim();
    let mut words = format.split_whitespace();
    if (words.next(), words.next()) != (Some("4.1"), Some("0")) {
        return Err(damaged(
            path,
            format!(
                "line 2: the mesh format is `{}`; allowed: `4.1 0 8` (version 4.1, ASCII)",
                clip(format, 40)
            ),
            SAVE_AGAIN,
        ));
    }
    Ok(())
}

/// A group that is needed has elements.
fn require(path: &Path, sections: &Sections, wanted: &str, count: usize) -> Result<(), CaseError> {
    if count > 0 {
        return Ok(());
    }
    let found: Vec<&str> = sections.names.values().map(String::as_str).collect();
    Err(damaged(
        path,
        format!(
            "physical group `{wanted}` is missing or empty; the groups are: {}",
            clip(&found.join(", "), 200)
        ),
        "name the groups steel (volume), pin_a, pin_b and rope_surface (surfaces) in Gmsh",
    ))
}

/// Skips a section that is not needed.
fn skip(lines: &mut Lines<'_>, tag: &str) -> Result<(), CaseError> {
    let Some(name) = tag.strip_prefix('$') else {
        return Err(lines.wrong("a section like `$Nodes` is expected here"));
    };
    let end = format!("$End{name}");
    while lines.line()?.trim() != end {}
    Ok(())
}

/// `dimension tag "name"` per group.
fn physical_names(lines: &mut Lines<'_>) -> Result<BTreeMap<(usize, i64), String>, CaseError> {
    let [count] = lines.integers::<1>()?;
    let mut names = BTreeMap::new();
    for _ in 0..count {
        let line = lines.line()?;
        let mut words = line.splitn(3, ' ');
        let place = words
            .next()
            .and_then(|w| w.parse().ok())
            .zip(words.next().and_then(|w| w.parse().ok()));
        let name = words
            .next()
            .map(|name| name.trim().trim_matches('"').to_owned());
        let (Some(place), Some(name)) = (place, name) else {
            return Err(lines.wrong("a physical group `dimension tag \"name\"` is expected here"));
        };
        names.insert(place, name);
    }
    lines.end("$EndPhysicalNames")?;
    Ok(names)
}

/// Physical tags per entity; everything else of the entities is not needed.
fn entities(lines: &mut Lines<'_>) -> Result<BTreeMap<(usize, i64), Vec<i64>>, CaseError> {
    let counts = lines.integers::<4>()?;
    let mut groups = BTreeMap::new();
    for (dimension, count) in counts.into_iter().enumerate() {
        // a point has a tag and a place, all others a tag and a box
        let skipped = if dimension == 0 { 4 } else { 7 };
        for _ in 0..count {
            let numbers = lines.numbers::<f64>(skipped + 1)?;
            let number = |at: usize| numbers.get(at).copied().unwrap_or_default();
            let tags = numbers.iter().skip(skipped + 1).copied().map(integer);
            let many = usize::try_from(integer(number(skipped))).unwrap_or(0);
            groups.insert((dimension, integer(number(0))), tags.take(many).collect());
        }
    }
    lines.end("$EndEntities")?;
    Ok(groups)
}

/// An integer that was read as a floating-point number.
fn integer(value: f64) -> i64 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "tags are small integers; saturating is safe"
    )]
    let integer = value as i64;
    integer
}

/// Blocks of node tags, then of positions.
fn nodes(lines: &mut Lines<'_>, sections: &mut Sections) -> Result<(), CaseError> {
    let [blocks, total, _, _] = lines.integers::<4>()?;
    for _ in 0..blocks {
        let [_, _, parametric, count] = lines.integers::<4>()?;
        if parametric != 0 {
            return Err(lines.wrong("parametric nodes are not supported"));
        }
        for _ in 0..count {
            let [tag] = lines.integers::<1>()?;
            let index = sections.index.len();
            if sections.index.insert(tag, index).is_some() {
                return Err(lines.wrong(&format!("node {tag} stands twice")));
            }
        }
        for _ in 0..count {
            let position = lines.numbers::<f64>(3)?;
            let Some(position) = position.first_chunk::<3>() else {
                return Err(lines.wrong("a position is expected here"));
            };
            if position.iter().any(|x| x.is_nan() || x.abs() >= 100.0) {
                return Err(
                    lines.wrong("a position outside -100 to 100 m: the mesh is not in metres")
                );
            }
            sections.mesh.nodes_m.push(*position);
        }
    }
    if i64::try_from(sections.index.len()) != Ok(total) {
        return Err(lines.wrong(&format!(
            "{total} nodes are announced, {} are there",
            sections.index.len()
        )));
    }
    lines.end("$EndNodes")
}
