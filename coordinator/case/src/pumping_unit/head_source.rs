//! What a reduction of a case's back head starts from: mesh, material, gauges, and where the tables are
//! kept that it makes.
use super::{
    mesh,
    read::{Resolved, resolve},
};
use crate::{
    error::{CaseError, damaged},
    source::{Overrides, Source, document},
};
use protocol::pumping_unit::{HeadGauge, PumpingUnit};
use std::path::{Path, PathBuf};

/// What a reduction of the back head starts from, and where its tables are kept.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadSource {
    /// The mesh.
    pub mesh: mesh::Mesh,
    /// Content hash of its file, in hexadecimal digits.
    pub mesh_blake3: String,
    /// Content hash of all that the reduction depends on.
    pub source_blake3: String,
    /// Young's modulus \[Pa\].
    pub young_pa: f64,
    /// Poisson's ratio \[1\].
    pub poisson: f64,
    /// Density [kg/m3].
    pub density_kg_m3: f64,
    /// Where stress is read.
    pub gauges: [HeadGauge; 4],
    /// Whether the case's tables are missing or were computed from something else.
    pub stale: bool,
    /// The file of the modes.
    pub modes_file: PathBuf,
    /// The file of the influence lines.
    pub influence_file: PathBuf,
    /// The file of the tables for a pair of ropes, where the case has one.
    pub twin_file: Option<PathBuf>,
}

/// Reads a case and what its back head is reduced from. Tables of another mesh are no error here.
///
/// # Errors
/// As [`crate::load()`]; a case without mesh or gauge places.
pub fn load_head(folder: &Path) -> Result<(PumpingUnit, HeadSource), CaseError> {
    let overrides = Overrides::default();
    let document = document(folder, &overrides)?;
    let Resolved {
        loaded,
        machine,
        head,
        flexible,
        twins,
        ..
    } = resolve(&Source::new(folder, &overrides, &document))?;
    let (Some((mesh, mesh_blake3)), Some(source_blake3)) = (head.mesh, head.source_blake3) else {
        return Err(damaged(
            &folder.join("case.toml"),
            "`flexible_head` names no mesh_file: there is nothing to reduce",
            "add mesh_file = \"FILE.msh\" (Gmsh 4.1)",
        ));
    };
    let modes_file = folder.join(&flexible.modes_file);
    let Some(gauges) = head.provenance.gauges else {
        return Err(damaged(
            &modes_file,
            "`gauges` does not place the gauges 1 to 4",
            "add \"gauges\": {\"1\": {\"x_m\": .., \"y_m\": .., \"z_m\": .., \"length_m\": ..}, ..}",
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
    Ok((PumpingUnit { case, machine }, source))
}
