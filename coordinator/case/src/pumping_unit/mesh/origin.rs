//! Check that the head's tables belong to its mesh, by content hashes and by mass.
use super::{super::head::Provenance, body::Mesh};
use crate::error::{CaseError, contradiction};
use std::path::Path;

/// Remedy for tables computed from another mesh.
const OUTDATED_TABLES_HELP: &str =
    "the tables belong to another mesh: `horsehead head CASE --write` computes them again";

/// Input of the head's reduction whose content hash the head's tables state.
#[derive(Clone, Copy, Debug)]
pub(in super::super) enum Origin {
    /// Mesh file alone.
    Mesh,
    /// All inputs of the reduction of the head: mesh, material, arc, stations and gauges.
    Source,
}

/// Checks that the head's tables were computed from the current mesh or other inputs, if both content hashes
/// are known.
///
/// # Errors
/// Returns an error if the tables state another content hash.
pub(in super::super) fn check_origin(
    path: &Path,
    origin: Origin,
    now: Option<&str>,
    stated: Option<&str>,
) -> Result<(), CaseError> {
    let (Some(hash), Some(stated)) = (now, stated) else {
        return Ok(());
    };
    if stated == hash {
        return Ok(());
    }
    let (field, has, remedy) = match origin {
        Origin::Mesh => (
            "mesh_blake3",
            "flexible_head.mesh_file has",
            OUTDATED_TABLES_HELP,
        ),
        Origin::Source => (
            "source_blake3",
            "mesh, material, arc and gauges have",
            "material, arc or gauges have changed since the tables were computed: `horsehead head CASE \
             --write` computes them again",
        ),
    };
    Err(contradiction(
        path,
        field,
        stated,
        format!("{has} {hash}"),
        remedy,
    ))
}

/// Checks that the head's tables were computed from this mesh, if they state a hash of it.
///
/// # Errors
/// Returns an error if the tables state another content hash.
pub(in super::super) fn check_hash(
    path: &Path,
    hash: &str,
    tables: &Provenance,
    modes_file: &Path,
) -> Result<(), CaseError> {
    match &tables.mesh_blake3 {
        Some(stated) if stated != hash => Err(contradiction(
            path,
            "the content of the mesh (blake3)",
            hash,
            format!("{}: mesh_blake3 = {stated}", modes_file.display()),
            OUTDATED_TABLES_HELP,
        )),
        Some(_) | None => Ok(()),
    }
}

/// Checks that the mass of the mesh equals the mass stated with the head's modes.
///
/// # Errors
/// Returns an error if volume times density differs from the modes' mass by more than 1 %.
pub(in super::super) fn check_mass(
    path: &Path,
    mesh: &Mesh,
    density_kg_m3: f64,
    (modes_file, mass_kg): (&Path, f64),
) -> Result<(), CaseError> {
    let mass = mesh.volume_m3() * density_kg_m3;
    if (mass / mass_kg - 1.0).abs() <= 0.01 {
        return Ok(());
    }
    Err(contradiction(
        path,
        format!(
            "the mass of the mesh (volume {:.6} m3 x {density_kg_m3} kg/m3)",
            mesh.volume_m3()
        ),
        format!("{mass:.1} kg"),
        format!(
            "{}: mass_kg = {mass_kg} (1 % is allowed)",
            modes_file.display()
        ),
        "mesh and modes belong to different heads, the mesh is not in metres, or \
         flexible_head.density_kg_m3 is wrong",
    ))
}
