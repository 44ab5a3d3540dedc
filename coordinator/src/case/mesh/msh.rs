//! Reads Gmsh MSH 4.1, ASCII: nodes, hexahedra, quadrilaterals, physical groups.
//!
//! The reader is our own, for two reasons found with the crate `mshio` 0.4.2: it skips
//! `$PhysicalNames` and the physical tags of entities, without which nothing says what a pin hole
//! is, and it panics on a malformed node count. It stays the judge of nodes and elements in the
//! tests.
use super::{
    super::{
        error::{CaseError, damaged},
        file,
        table::clip,
    },
    Mesh, SURFACES, VOLUME,
};
use std::{collections::BTreeMap, path::Path};

/// What to do about a mesh that cannot be read.
const SAVE_AGAIN: &str = "save the mesh again as MSH 4.1 ASCII (gmsh -format msh41), \
                          8-node hexahedra of order 1";

/// Reads a mesh.
///
/// # Errors
/// Another version or a binary file, malformed sections (with the line), other elements than
/// hexahedra and quadrilaterals, a missing physical group, an element that is inside out.
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
            "$Elements" => elements(&mut lines, &mut sections)?,
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
    let mesh = sections.mesh;
    for (group, elements) in &mesh.volumes {
        let inverted = |element: &[usize; 8]| mesh.element_volume_m3(element) <= 0.0;
        if let Some(at) = elements.iter().position(inverted) {
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
    Ok(mesh)
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

/// Lines of the file, counted.
struct Lines<'a> {
    path: &'a Path,
    rest: std::str::Lines<'a>,
    number: usize,
}

impl<'a> Lines<'a> {
    fn new(path: &'a Path, text: &'a str) -> Self {
        Self {
            path,
            rest: text.lines(),
            number: 0,
        }
    }

    fn next(&mut self) -> Option<&'a str> {
        self.number += 1;
        self.rest.next()
    }

    /// An error at the line that was read last.
    fn wrong(&self, problem: &str) -> CaseError {
        damaged(
            self.path,
            format!("line {}: {problem}", self.number),
            SAVE_AGAIN,
        )
    }

    /// The next line, which must be there.
    fn line(&mut self) -> Result<&'a str, CaseError> {
        self.next()
            .ok_or_else(|| self.wrong("the file ends inside a section"))
    }

    /// The numbers of the next line; at least `least` of them.
    fn numbers<T: std::str::FromStr>(&mut self, least: usize) -> Result<Vec<T>, CaseError> {
        let line = self.line()?;
        let words = line.split_ascii_whitespace();
        let numbers: Result<Vec<T>, _> = words.map(str::parse).collect();
        match numbers {
            Ok(numbers) if numbers.len() >= least => Ok(numbers),
            _ => Err(self.wrong(&format!("at least {least} numbers are expected here"))),
        }
    }

    /// Exactly `N` integers; further numbers of the line are ignored.
    fn integers<const N: usize>(&mut self) -> Result<[i64; N], CaseError> {
        let numbers = self.numbers::<i64>(N)?;
        numbers
            .first_chunk::<N>()
            .copied()
            .ok_or_else(|| self.wrong("numbers are missing"))
    }

    /// The end of a section.
    fn end(&mut self, tag: &str) -> Result<(), CaseError> {
        if self.line()?.trim() == tag {
            Ok(())
        } else {
            Err(self.wrong(&format!("`{tag}` is expected here")))
        }
    }
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

/// Blocks of elements, each of one type and one entity.
fn elements(lines: &mut Lines<'_>, sections: &mut Sections) -> Result<(), CaseError> {
    const QUADRILATERAL: i64 = 3;
    const HEXAHEDRON: i64 = 5;
    let [blocks, _, _, _] = lines.integers::<4>()?;
    for _ in 0..blocks {
        let [dimension, entity, kind, count] = lines.integers::<4>()?;
        let dimension = usize::try_from(dimension).unwrap_or(usize::MAX);
        let groups: Vec<String> = sections
            .groups
            .get(&(dimension, entity))
            .into_iter()
            .flatten()
            .filter_map(|tag| sections.names.get(&(dimension, *tag)).cloned())
            .collect();
        match kind {
            QUADRILATERAL => {
                let read = block::<5, 4>(lines, count, &sections.index)?;
                for group in groups {
                    sections
                        .mesh
                        .surfaces
                        .entry(group)
                        .or_default()
                        .extend(&read);
                }
            }
            HEXAHEDRON => {
                let read = block::<9, 8>(lines, count, &sections.index)?;
                for group in groups {
                    sections
                        .mesh
                        .volumes
                        .entry(group)
                        .or_default()
                        .extend(&read);
                }
            }
            // points and lines of the geometry carry nothing
            _ if dimension < 2 => {
                for _ in 0..count {
                    lines.line()?;
                }
            }
            _ => {
                return Err(lines.wrong(&format!(
                    "element type {kind}; allowed: 3 (4-node quadrilateral), 5 (8-node hexahedron)"
                )));
            }
        }
    }
    lines.end("$EndElements")
}

/// `count` elements: a tag and N node tags each, which become indices.
fn block<const LINE: usize, const N: usize>(
    lines: &mut Lines<'_>,
    count: i64,
    index: &BTreeMap<i64, usize>,
) -> Result<Vec<[usize; N]>, CaseError> {
    let mut elements = Vec::new();
    for _ in 0..count {
        let numbers = lines.integers::<LINE>()?;
        let mut element = [0; N];
        for (node, tag) in element.iter_mut().zip(numbers.iter().skip(1)) {
            *node = *index
                .get(tag)
                .ok_or_else(|| lines.wrong(&format!("node {tag} does not exist")))?;
        }
        elements.push(element);
    }
    Ok(elements)
}
