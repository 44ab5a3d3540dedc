//! The back head's mesh: elements of one kind in named groups, and whether it is the head of the modes.
//!
//! Checking it takes some milliseconds, so every load reads it whole; nothing of it travels.
mod msh;
mod volume;

pub use msh::read;
pub(super) use msh::read_hashed;

use super::{
    error::{CaseError, contradiction},
    head::Provenance,
};
use protocol::job::ElementKind;
use std::{collections::BTreeMap, path::Path};

/// A mesh with named groups.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Node positions in the beam frame \[m\].
    pub nodes_m: Vec<[f64; 3]>,
    /// What its elements are.
    pub kind: ElementKind,
    /// Elements per volume group: indices of nodes, element after element, in Gmsh's order.
    pub volumes: BTreeMap<String, Vec<usize>>,
    /// Faces per surface group: indices of nodes, face after face.
    pub surfaces: BTreeMap<String, Vec<usize>>,
    /// Whether it is the half z >= 0 of the head: it has a group [`SYMMETRY`].
    pub half: bool,
}

/// The group of all elements.
pub const VOLUME: &str = "steel";
/// The groups of the held pin holes and of the loaded rim.
pub const SURFACES: [&str; 3] = ["pin_a", "pin_b", "rope_surface"];
/// The group of the cut face in the plane z = 0, which only a half has.
pub const SYMMETRY: &str = "symmetry";

impl Mesh {
    /// Volume of the head \[m3\]: of all elements, twice that of a half.
    pub fn volume_m3(&self) -> f64 {
        let elements = self.volumes.values();
        let elements = elements.flat_map(|group| group.chunks_exact(self.kind.nodes()));
        let sum: f64 = elements
            .filter_map(|element| self.element_volume_m3(element))
            .sum();
        if self.half { 2.0 * sum } else { sum }
    }

    /// Volume of one element \[m3\]; none if it is inside out.
    fn element_volume_m3(&self, element: &[usize]) -> Option<f64> {
        let place = |&node: &usize| self.nodes_m.get(node).copied().unwrap_or_default();
        let places: Vec<[f64; 3]> = element.iter().map(place).collect();
        volume::of(self.kind, &places)
    }
}

/// What to do about tables of another mesh.
const ANOTHER: &str =
    "the tables belong to another mesh: `horsehead head CASE --write` computes them again";

/// What tables of the head say that they were computed from, by its content hash.
#[derive(Clone, Copy, Debug)]
pub(super) enum Origin {
    /// The mesh file.
    Mesh,
    /// All that a reduction depends on: mesh, material, arc, stations, gauges.
    Source,
}

/// Tables were computed from what is there now, as far as that is known and they say so.
///
/// # Errors
/// They name another content.
pub(super) fn check_origin(
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
        Origin::Mesh => ("mesh_blake3", "flexible_head.mesh_file has", ANOTHER),
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
