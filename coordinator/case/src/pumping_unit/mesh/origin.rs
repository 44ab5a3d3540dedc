//! Check that the head's tables belong to its mesh, by content hashes and by mass.
use super::{super::head::Provenance, body::Mesh};
use crate::error::{CaseError, contradiction};
use protocol::pumping_unit::BackHead;
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

/// Share of the head's radius by which the rope surface of its mesh may lie beside the rope's centre line in the mean:
/// half of a thick rope, and the roundness of a weldment.
const RIM_TOLERANCE: f64 = 0.015;

/// Share of the head's radius by which a node of the rope surface may be farther from the head's centre than the mean of
/// all; a mesh that is shifted by more than a few millimetres exceeds it.
const RIM_ROUNDNESS: f64 = 0.002;

/// Checks that the rope surface of a mesh is an arc of the head's radius about its centre, as it is only in the frame of
/// the beam and in metres.
///
/// # Errors
/// Returns an error if the mean distance of its nodes differs by more than [`RIM_TOLERANCE`], or that of a node from the
/// mean by more than [`RIM_ROUNDNESS`].
pub(in super::super) fn check_rim(
    path: &Path,
    mesh: &Mesh,
    head: &BackHead,
) -> Result<(), CaseError> {
    let rim = mesh.surfaces.get("rope_surface").into_iter().flatten();
    let distances = rim.filter_map(|node| {
        let [x, y, _] = mesh.nodes_m.get(*node)?;
        Some((x - head.center_x_m).hypot(y - head.center_y_m))
    });
    let distances: Vec<f64> = distances.collect();
    let mean = distances.iter().sum::<f64>() / distances.len() as f64;
    let off = distances.iter().map(|own| (own - mean).abs());
    let off = off.fold(0.0, f64::max);
    let is_arc = off <= RIM_ROUNDNESS * head.radius_m;
    if is_arc && (mean / head.radius_m - 1.0).abs() <= RIM_TOLERANCE {
        return Ok(());
    }
    Err(contradiction(
        path,
        "the distance of the group `rope_surface` from the head's centre",
        format!("{mean:.4} m in the mean, and up to {off:.4} m beside that"),
        format!(
            "case.toml: back_head.radius_m = {} about ({}, {}); allowed are {:.1} % and {:.1} % of it",
            head.radius_m,
            head.center_x_m,
            head.center_y_m,
            100.0 * RIM_TOLERANCE,
            100.0 * RIM_ROUNDNESS
        ),
        "the mesh must be in the frame of the beam: origin at the pivot, x towards the well, y up; a mesh in \
         millimetres needs flexible_head.mesh_unit_m = 0.001, one in inches 0.0254; the group must hold the faces under \
         the rope alone",
    ))
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
