//! Reading of a whole mesh file: format, sections in any order, then the checks of the complete mesh.
use super::{
    super::body::Mesh,
    elements,
    lines::{Lines, SAVE_AGAIN},
    sections::{Sections, entities, nodes, physical_names},
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
    read_hashed(path).map(|(mesh, _)| mesh)
}

/// Reads a mesh; returns it with the BLAKE3 hash of the file's content in hexadecimal digits.
pub(in super::super::super) fn read_hashed(path: &Path) -> Result<(Mesh, String), CaseError> {
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
    whole::validated_mesh(path, sections)
}

/// Checks the format line before the bytes are decoded as text.
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

/// Skips a section of the mesh file that is not needed.
fn skip(lines: &mut Lines<'_>, tag: &str) -> Result<(), CaseError> {
    let Some(name) = tag.strip_prefix('$') else {
        return Err(lines.wrong("a section like `$Nodes` is expected here"));
    };
    let end = format!("$End{name}");
    while lines.line()?.trim() != end {}
    Ok(())
}
