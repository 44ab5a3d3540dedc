//! Inputs of a reduction of a case's back head (mesh, material, gauges) and the files for its results.
use super::{
    mesh,
    read::{Resolved, StaleTables, resolve},
};
use crate::{
    error::{CaseError, damaged},
    source::{Overrides, RecordFolder, document},
};
use protocol::pumping_unit::{HeadGauge, PumpingUnit};
use std::path::{Path, PathBuf};

/// Inputs of a reduction of the back head, and the files for its tables.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadSource {
    /// Mesh of the back head.
    pub mesh: mesh::Mesh,
    /// Content hash of the mesh file, in hexadecimal digits.
    pub mesh_blake3: String,
    /// Content hash of all inputs of the reduction.
    pub source_blake3: String,
    /// Young's modulus \[Pa\].
    pub young_pa: f64,
    /// Poisson's ratio \[1\].
    pub poisson: f64,
    /// Density [kg/m3].
    pub density_kg_m3: f64,
    /// Locations of the four gauges at which stress is evaluated.
    pub gauges: [HeadGauge; 4],
    /// Whether the case's tables of modes and influence lines are missing or were computed from other inputs.
    pub stale: bool,
    /// File to which the modes of the reduced head are written.
    pub modes_file: PathBuf,
    /// File to which the influence lines of the reduced head are written.
    pub influence_file: PathBuf,
    /// File to which the tables for a pair of ropes are written, if the case has one.
    pub twin_file: Option<PathBuf>,
}

impl HeadSource {
    /// Returns the distance of each gauge from the surface of the mesh \[m\].
    pub fn surface_distances_m(&self) -> Vec<f64> {
        let points = self.gauges.map(|gauge| gauge.position_m);
        mesh::surface_distances_m(&self.mesh, &points)
    }
}

/// Loads a case with the inputs of its back head's reduction. Tables computed from another mesh are accepted
/// here.
///
/// # Errors
/// As [`crate::load()`]; also for a case without mesh or gauge locations.
pub fn load_head(folder: &Path) -> Result<(PumpingUnit, HeadSource), CaseError> {
    load_meshed_head(folder)?.ok_or_else(|| {
        damaged(
            &folder.join("case.toml"),
            "`flexible_head` names no mesh_file: there is nothing to reduce",
            "add mesh_file = \"FILE.msh\" (Gmsh 4.1)",
        )
    })
}

/// Loads what [`load_head`] does; `None` for a case without mesh.
///
/// # Errors
/// As [`load_head`], but for the mesh.
pub fn load_meshed_head(folder: &Path) -> Result<Option<(PumpingUnit, HeadSource)>, CaseError> {
    let overrides = Overrides::default();
    let document = document(folder, &overrides)?;
    let Resolved {
        loaded,
        machine,
        head,
        flexible,
        twins,
        ..
    } = resolve(
        &RecordFolder::new(folder, &overrides, &document),
        StaleTables::Accepted,
    )?;
    let (Some((mesh, mesh_blake3)), Some(source_blake3)) = (head.mesh, head.source_blake3) else {
        return Ok(None);
    };
    let modes_file = folder.join(&flexible.modes_file);
    let Some(gauges) = head.provenance.gauges else {
        return Err(damaged(
            &modes_file,
            "neither it nor the case places the gauges 1 to 4",
            "add gauges.1 = { x_m = .., y_m = .., z_m = .., length_m = .. } to 4 to [flexible_head] of case.toml",
        ));
    };
    let source = HeadSource {
        mesh,
        mesh_blake3,
        source_blake3,
        young_pa: flexible.young_gpa * 1e9,
        poisson: flexible.poisson,
        density_kg_m3: flexible.density_kg_m3,
        gauges,
        stale: head.stale.is_some(),
        influence_file: folder.join(&flexible.influence_file),
        twin_file: twins.map(|entry| folder.join(entry.head_file)),
        modes_file,
    };
    let case = loaded.case;
    Ok(Some((PumpingUnit { case, machine }, source)))
}
