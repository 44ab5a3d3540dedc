//! Reading of the flexible head of a case: its tables and its mesh, with a check that they belong together.
use super::{head, mesh, schema::CaseFile, twin};
use crate::{
    document::{Document, DocumentStep},
    error::{CaseError, Faults},
    file,
};
use protocol::pumping_unit::{ModalHead, TwinRopes};
use std::path::Path;

/// Flexible back head of a pumping unit as read from its files: modes, influence lines and mesh.
pub(super) struct ReadHead {
    pub(super) head: ModalHead,
    pub(super) provenance: head::Provenance,
    /// Mesh of the back head and the content hash of its file, if the case names one.
    pub(super) mesh: Option<(mesh::Mesh, String)>,
    /// Content hash of all inputs from which the head's tables were reduced; `None` without a mesh.
    pub(super) source_blake3: Option<String>,
    /// Data of two ropes on each head, with the head's response to a pair of ropes, if the case has them.
    pub(super) twins: Option<TwinRopes>,
    /// Error that explains why the head's tables of modes and influence lines are out of date or do not fit
    /// together; `None` if they are valid.
    pub(super) stale: Option<CaseError>,
}

/// Reads the back head's modes and influence lines and, if the case names one, the mesh that they belong to.
pub(super) fn read(
    folder: &Path,
    document: &Document,
    file: &CaseFile,
) -> Result<ReadHead, CaseError> {
    let flexible = &file.flexible_head;
    let modes_file = folder.join(&flexible.modes_file);
    let mut faults = Faults::default();
    let named = [&flexible.modes_file, &flexible.influence_file].into_iter();
    for name in named.chain(&flexible.mesh_file) {
        let role = format!(
            "a table of the back head, named in {}",
            document.path.display()
        );
        faults.take(file::require_exists(&folder.join(name), &role));
    }
    faults.end()?;
    let (mut head, provenance) = head::read(&modes_file, &folder.join(&flexible.influence_file))?;
    head.stress = flexible.stress;
    let mut read = ReadHead {
        head,
        provenance,
        mesh: None,
        source_blake3: None,
        twins: None,
        stale: None,
    };
    if let Some(name) = &flexible.mesh_file {
        let path = folder.join(name);
        let (mesh, hash) = mesh::read_hashed(&path)?;
        read.stale = mesh::check_hash(&path, &hash, &read.provenance, &modes_file).err();
        // what belongs to another mesh has another mass: the hash says it better
        if read.stale.is_none() {
            let mass = (modes_file.as_path(), read.head.mass_kg);
            mesh::check_mass(&path, &mesh, flexible.density_kg_m3, mass)?;
        }
        let source = source_hash(&hash, file, &read);
        if read.stale.is_none() {
            let stated = read.provenance.source_blake3.as_deref();
            read.stale =
                mesh::check_origin(&modes_file, mesh::Origin::Source, Some(&source), stated).err();
        }
        read.source_blake3 = Some(source);
        read.mesh = Some((mesh, hash));
    }
    if let Some(entry) = &file.twin_ropes {
        let hashes = twin::Hashes {
            mesh: read.mesh.as_ref().map(|(_, hash)| hash.as_str()),
            source: read.source_blake3.as_deref(),
        };
        let pair = twin::read(folder, entry, &read.head, hashes)?;
        read.twins = Some(pair.twins);
        read.stale = read.stale.or(pair.unfit);
    }
    let available = read.head.frequencies_hz.len();
    if file.run.modes > available {
        return Err(document.field(
            &[DocumentStep::Key("run"), DocumentStep::Key("modes")],
            file.run.modes,
            format!(
                "0 to {available}, the modes of {}",
                flexible.modes_file.display()
            ),
            "take fewer modes, or reduce the head with more",
        ));
    }
    Ok(read)
}

/// Returns the content hash of all inputs of a reduction: mesh, material, arc, stations and gauges.
fn source_hash(mesh: &str, file: &CaseFile, read: &ReadHead) -> String {
    let flexible = &file.flexible_head;
    let mut hasher = blake3::Hasher::new();
    hasher.update(mesh.as_bytes());
    let mut take = |numbers: &[f64]| {
        for number in numbers {
            hasher.update(&number.to_le_bytes());
        }
    };
    take(&[
        flexible.young_gpa,
        flexible.poisson,
        flexible.density_kg_m3,
        file.back_head.center_x_m,
        file.back_head.center_y_m,
    ]);
    for gauge in read.provenance.gauges.iter().flatten() {
        take(&gauge.position_m);
        take(&[gauge.length_m]);
    }
    take(&read.head.arc_deg);
    hasher.finalize().to_hex().to_string()
}
