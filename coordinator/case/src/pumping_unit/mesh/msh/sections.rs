//! Reading of the mesh file sections for group names, entities and nodes.
use super::{super::body::Mesh, kind::Block, lines::Lines};
use crate::error::CaseError;
use std::collections::BTreeMap;

/// Version of the file format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Version {
    /// MSH 2.2: nodes and elements are plain lists, elements name their physical group.
    V22,
    /// MSH 4.1: nodes and elements stand in blocks, geometric entities name their physical groups.
    #[default]
    V41,
}

/// Contents of those sections of the mesh file that have been read so far.
#[derive(Debug, Default)]
pub(super) struct Sections {
    pub(super) version: Version,
    /// Length of the unit in which the file's positions are \[m\].
    pub(super) unit_m: f64,
    /// Map from (dimension, physical tag) to the name of the physical group.
    pub(super) names: BTreeMap<(usize, i64), String>,
    /// Map from (dimension, entity tag) to the tags of the physical groups that contain the entity.
    pub(super) groups: BTreeMap<(usize, i64), Vec<i64>>,
    /// Elements as read, in the order of the file.
    pub(super) blocks: Vec<Block>,
    /// Map from the tag of a node in the file to its index in the mesh.
    pub(super) index: BTreeMap<i64, usize>,
    pub(super) mesh: Mesh,
    /// Tag in the file of each element of the body, in the order of the mesh.
    pub(super) body: Vec<i64>,
}

/// Reads the names of the physical groups, one line `dimension tag "name"` each.
pub(super) fn physical_names(
    lines: &mut Lines<'_>,
) -> Result<BTreeMap<(usize, i64), String>, CaseError> {
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

/// Reads the physical tags of each entity; the other data of the entities are ignored.
pub(super) fn entities(
    lines: &mut Lines<'_>,
) -> Result<BTreeMap<(usize, i64), Vec<i64>>, CaseError> {
    let counts = lines.integers::<4>()?;
    let mut groups = BTreeMap::new();
    for (dimension, count) in counts.into_iter().enumerate() {
        // a point has a tag and a place, all others a tag and a box
        let skipped = if dimension == 0 { 4 } else { 7 };
        for _ in 0..count {
            let numbers = lines.numbers::<f64>(skipped + 1)?;
            let number = |at: usize| numbers.get(at).copied().unwrap_or_default();
            // Gmsh negates the tag where the orientation is reversed
            let tags = numbers.iter().skip(skipped + 1);
            let tags = tags.map(|tag| integer(tag.abs()));
            let many = usize::try_from(integer(number(skipped))).unwrap_or(0);
            groups.insert((dimension, integer(number(0))), tags.take(many).collect());
        }
    }
    lines.end("$EndEntities")?;
    Ok(groups)
}

/// Converts an integer that was read as a floating-point number.
fn integer(value: f64) -> i64 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "tags are small integers; saturating is safe"
    )]
    let integer = value as i64;
    integer
}

/// Reads the nodes of the file's version.
pub(super) fn nodes(lines: &mut Lines<'_>, sections: &mut Sections) -> Result<(), CaseError> {
    let total = match sections.version {
        Version::V22 => flat_nodes(lines, sections)?,
        Version::V41 => node_blocks(lines, sections)?,
    };
    if i64::try_from(sections.index.len()) != Ok(total) {
        return Err(lines.wrong(&format!(
            "the section declares {total} nodes but contains {}",
            sections.index.len()
        )));
    }
    lines.end("$EndNodes")
}

/// Reads the nodes of MSH 2.2, each a line of tag and position; returns their stated number.
fn flat_nodes(lines: &mut Lines<'_>, sections: &mut Sections) -> Result<i64, CaseError> {
    let [total] = lines.integers::<1>()?;
    for _ in 0..total {
        let numbers = lines.numbers::<f64>(4)?;
        let Some(&[tag, x, y, z]) = numbers.first_chunk::<4>() else {
            return Err(lines.wrong("a tag and a position are expected here"));
        };
        sections.add_tag(lines, integer(tag))?;
        sections.add_position(lines, [x, y, z])?;
    }
    Ok(total)
}

/// Reads the nodes of MSH 4.1, in blocks of first the tags, then the positions; returns their stated number.
fn node_blocks(lines: &mut Lines<'_>, sections: &mut Sections) -> Result<i64, CaseError> {
    let [blocks, total, _, _] = lines.integers::<4>()?;
    for _ in 0..blocks {
        let [_, _, parametric, count] = lines.integers::<4>()?;
        if parametric != 0 {
            return Err(lines.wrong("parametric nodes are not supported"));
        }
        for _ in 0..count {
            let [tag] = lines.integers::<1>()?;
            sections.add_tag(lines, tag)?;
        }
        for _ in 0..count {
            let position = lines.numbers::<f64>(3)?;
            let Some(position) = position.first_chunk::<3>() else {
                return Err(lines.wrong("a position is expected here"));
            };
            sections.add_position(lines, *position)?;
        }
    }
    Ok(total)
}

impl Sections {
    fn add_tag(&mut self, lines: &Lines<'_>, tag: i64) -> Result<(), CaseError> {
        let index = self.index.len();
        match self.index.insert(tag, index) {
            Some(_) => Err(lines.wrong(&format!("node {tag} is defined twice"))),
            None => Ok(()),
        }
    }

    fn add_position(&mut self, lines: &Lines<'_>, position: [f64; 3]) -> Result<(), CaseError> {
        let position_m = position.map(|x| x * self.unit_m);
        if position_m.iter().any(|x| x.is_nan() || x.abs() >= 100.0) {
            return Err(lines.wrong_with(
                &format!(
                    "a position outside -100 to 100 m, the unit of the mesh being {} m",
                    self.unit_m
                ),
                "state the unit: flexible_head.mesh_unit_m = 0.001 for a mesh in millimetres, \
                 0.0254 for inches",
            ));
        }
        self.mesh.nodes_m.push(position_m);
        Ok(())
    }
}
