//! The back head's mesh: 8-node hexahedra in named groups, and whether it is the head of the modes.
//!
//! Checking it takes some milliseconds, so every load reads it whole; nothing of it travels.
mod msh;

pub use msh::read;
pub(super) use msh::read_hashed;

use super::{
    error::{CaseError, contradiction},
    head::Provenance,
};
use std::{collections::BTreeMap, path::Path};

/// A mesh of hexahedra with named groups.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Node positions in the beam frame \[m\].
    pub nodes_m: Vec<[f64; 3]>,
    /// Hexahedra per volume group: indices of nodes, in Gmsh's order.
    pub volumes: BTreeMap<String, Vec<[usize; 8]>>,
    /// Quadrilaterals per surface group: indices of nodes.
    pub surfaces: BTreeMap<String, Vec<[usize; 4]>>,
}

/// The group of all elements.
pub const VOLUME: &str = "steel";
/// The groups of the held pin holes and of the loaded rim.
pub const SURFACES: [&str; 3] = ["pin_a", "pin_b", "rope_surface"];

impl Mesh {
    /// Volume of all hexahedra \[m3\].
    pub fn volume_m3(&self) -> f64 {
        let elements = self.volumes.values().flatten();
        elements
            .map(|element| self.element_volume_m3(element))
            .sum()
    }

    /// Volume of one hexahedron \[m3\], exact by 2 x 2 x 2 Gauss points; negative if inside out.
    fn element_volume_m3(&self, element: &[usize; 8]) -> f64 {
        let corner = |&node: &usize| self.nodes_m.get(node).copied().unwrap_or_default();
        let corners: Vec<[f64; 3]> = element.iter().map(corner).collect();
        let at = 1.0 / 3.0_f64.sqrt();
        let mut volume = 0.0;
        for point in &SIGNS {
            let [r, s, t] = point.map(|sign| sign * at);
            let mut jacobian = [[0.0; 3]; 3];
            for (sign, corner) in SIGNS.iter().zip(&corners) {
                let [a, b, c] = *sign;
                let slopes = [
                    a * (1.0 + b * s) * (1.0 + c * t) / 8.0,
                    b * (1.0 + a * r) * (1.0 + c * t) / 8.0,
                    c * (1.0 + a * r) * (1.0 + b * s) / 8.0,
                ];
                for (row, slope) in jacobian.iter_mut().zip(slopes) {
                    for (entry, x) in row.iter_mut().zip(corner) {
                        *entry += slope * x;
                    }
                }
            }
            let [[a, b, c], [d, e, f], [g, h, i]] = jacobian;
            volume += a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
        }
        volume
    }
}

/// Corners of the reference cube in Gmsh's order.
const SIGNS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// What to do about tables of another mesh.
const ANOTHER: &str =
    "the tables belong to another mesh: `horsehead head CASE --write` computes them again";

/// The tables were computed from this mesh, as far as they say.
///
/// # Errors
/// They name another content.
pub(super) fn check_hash(
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
            ANOTHER,
        )),
        Some(_) | None => Ok(()),
    }
}

/// The tables of a pair of ropes were computed from this mesh, as far as they say.
///
/// # Errors
/// They name another content.
pub(super) fn check_twin_hash(
    path: &Path,
    hash: Option<&str>,
    stated: Option<&str>,
) -> Result<(), CaseError> {
    match (hash, stated) {
        (Some(hash), Some(stated)) if stated != hash => Err(contradiction(
            path,
            "mesh_blake3",
            stated,
            format!("flexible_head.mesh_file has {hash}"),
            ANOTHER,
        )),
        _ => Ok(()),
    }
}

/// The mesh is the steel whose modes the case uses.
///
/// # Errors
/// Volume times density differs from the modes' mass by more than 1 %.
pub(super) fn check_mass(
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
