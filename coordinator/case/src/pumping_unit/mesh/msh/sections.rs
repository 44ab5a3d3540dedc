//! Reading of the mesh file sections for group names, entities and nodes.
use super::{super::body::Mesh, lines::Lines};
use crate::error::CaseError;
use std::collections::BTreeMap;

/// Contents of those sections of the mesh file that have been read so far.
#[derive(Debug, Default)]
pub(super) struct Sections {
    /// Map from (dimension, physical tag) to the name of the physical group.
    pub(super) names: BTreeMap<(usize, i64), String>,
    /// Map from (dimension, entity tag) to the tags of the physical groups that contain the entity.
    pub(super) groups: BTreeMap<(usize, i64), Vec<i64>>,
    /// Map from the tag of a node in the file to its index in the mesh.
    pub(super) index: BTreeMap<i64, usize>,
    pub(super) mesh: Mesh,
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
            let tags = numbers.iter().skip(skipped + 1).copied().map(integer);
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

/// Reads the mesh file's blocks of nodes: in each block first the tags, then the positions.
pub(super) fn nodes(lines: &mut Lines<'_>, sections: &mut Sections) -> Result<(), CaseError> {
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
                return Err(lines.wrong(&format!("node {tag} is defined twice")));
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
            "the section declares {total} nodes but contains {}",
            sections.index.len()
        )));
    }
    lines.end("$EndNodes")
}
