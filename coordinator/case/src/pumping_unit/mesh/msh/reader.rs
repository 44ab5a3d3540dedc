//! Reading of a whole mesh file: format, sections in any order, then the checks of the complete mesh.
use super::{
    super::body::Mesh,
    elements,
    lines::{Lines, SAVE_AGAIN},
    sections::{Sections, Version, entities, nodes, physical_names},
    whole,
};
use crate::{
    error::{CaseError, damaged},
    file,
    table::clip,
};
use std::path::Path;

/// Reads a mesh.
///
/// # Errors
/// Returns an error for another version or a binary file, malformed sections (with the line), elements of a
/// type that is not allowed or of two kinds, a missing physical group, a group with a node that belongs to no
/// element, an inverted element, and a half mesh that does not end at the plane z = 0.
pub fn read(path: &Path) -> Result<Mesh, CaseError> {
    read_hashed(path, 1.0).map(|(mesh, _)| mesh)
}

/// Reads a mesh whose unit of length is `unit_m` metres; returns it in metres, with the BLAKE3 hash of the
/// file's content in hexadecimal digits.
pub(in super::super::super) fn read_hashed(
    path: &Path,
    unit_m: f64,
) -> Result<(Mesh, String), CaseError> {
    let bytes = file::read(path, "the mesh of the back head, `flexible_head.mesh_file`")?;
    let hash = blake3::hash(&bytes).to_hex().to_string();
    Ok((parse(path, bytes, unit_m)?, hash))
}

fn parse(path: &Path, bytes: Vec<u8>, unit_m: f64) -> Result<Mesh, CaseError> {
    let mut sections = Sections {
        version: version(path, &bytes)?,
        unit_m,
        ..Sections::default()
    };
    let text = file::text(path, bytes)?;
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
    elements::join(path, &mut sections)?;
    whole::validated_mesh(path, sections)
}

/// Reads the version from the format line, before the bytes are decoded as text.
fn version(path: &Path, bytes: &[u8]) -> Result<Version, CaseError> {
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
    match (words.next(), words.next()) {
        (Some("4.1"), Some("0")) => Ok(Version::V41),
        (Some("2.2"), Some("0")) => Ok(Version::V22),
        _ => Err(damaged(
            path,
            format!(
                "line 2: the mesh format is `{}`; allowed: `4.1 0 8` or `2.2 0 8` (ASCII)",
                clip(format, 40)
            ),
            SAVE_AGAIN,
        )),
    }
}

/// Skips a section of the mesh file that is not needed.
fn skip(lines: &mut Lines<'_>, tag: &str) -> Result<(), CaseError> {
    let Some(name) = tag.strip_prefix('$') else {
        return Err(lines.wrong("a section like `$Nodes` is expected here"));
    };
    let end = format!("$End{name}");
    while lines.line()?.trim() != end {}
    Ok(())
}
