//! Reading of the flexible head of a case: its tables and its mesh, with a check that they belong together.
use super::{
    geometry, head, mesh,
    record::whole,
    schema::{CaseFile, FlexibleHead},
    twin,
};
use crate::{
    document::{Document, DocumentStep},
    error::{CaseError, Faults, contradiction, damaged},
    file,
    note::Note,
};
use protocol::pumping_unit::{
    BackHead, HeadGauge, Influence, ModalHead, StressRecovery, TwinRopes,
};
use std::path::{Path, PathBuf};

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
    /// Note about the mesh, if there is one.
    pub(super) notes: Option<Note>,
}

impl ReadHead {
    /// Creates a head without mesh and second rope.
    const fn new(head: ModalHead, provenance: head::Provenance, stale: Option<CaseError>) -> Self {
        Self {
            head,
            provenance,
            mesh: None,
            source_blake3: None,
            twins: None,
            stale,
            notes: None,
        }
    }
}

/// Reads the back head's modes and influence lines and, if the case names one, the mesh that they belong to.
/// Tables that are missing but follow from mesh and gauges are replaced by empty ones, with the reason in
/// [`ReadHead::stale`].
pub(super) fn read(
    folder: &Path,
    document: &Document,
    file: &CaseFile,
) -> Result<ReadHead, CaseError> {
    let flexible = &file.flexible_head;
    let modes_file = folder.join(&flexible.modes_file);
    let mut read = tables(folder, document, file)?;
    read.head.stress = flexible.stress;
    let unreduced = read.head.frequencies_hz.is_empty();
    if let Some(name) = &flexible.mesh_file {
        let path = folder.join(name);
        let (mesh, hash) = mesh::read_hashed(&path, mesh_unit_m(document, flexible)?)?;
        mesh::check_rim(&path, &mesh, &file.back_head)?;
        if unreduced {
            clip_stations(&mut read.head, &mesh, &file.back_head);
            read.head.mass_kg = mesh.volume_m3() * flexible.density_kg_m3;
        } else {
            let outdated = mesh::check_hash(&path, &hash, &read.provenance, &modes_file).err();
            read.stale = outdated.or(read.stale);
        }
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
        let visible = mesh.straightened_m.filter(|off_m| *off_m > 1e-6);
        read.notes = visible.map(|off_m| straightened(path, off_m));
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
    if file.run.modes > available && !unreduced {
        let from_mesh = read.mesh.is_some() && read.provenance.gauges.is_some();
        let fault = document.field(
            &["run", "modes"].map(DocumentStep::Key),
            file.run.modes,
            format!(
                "0 to {available}, the modes of {}",
                flexible.modes_file.display()
            ),
            if from_mesh {
                "take fewer modes; or `horsehead head CASE --write` computes as many from the mesh"
            } else {
                "take fewer modes, or tables with more"
            },
        );
        if !from_mesh {
            return Err(fault);
        }
        read.stale = read.stale.or(Some(fault));
    }
    Ok(read)
}

/// Returns the note that the edges of second-order elements were straightened.
fn straightened(path: PathBuf, off_m: f64) -> Note {
    Note {
        path,
        text: format!(
            "of second-order bricks the corners are used, as bricks with incompatible modes; mid-edge \
             nodes lie up to {:.3} mm beside the straight edges",
            1e3 * off_m
        ),
    }
}

/// Returns an error for each table of the head that does not exist; its remedy depends on whether the case has a mesh
/// and the places of the gauges.
fn absent(
    folder: &Path,
    document: &Document,
    (flexible, has_gauges): (&FlexibleHead, bool),
) -> Vec<CaseError> {
    let help = match (&flexible.mesh_file, has_gauges) {
        (Some(_), true) => "`horsehead head CASE --write` computes both tables from the mesh",
        (Some(_), false) => {
            "state the places of the gauges, flexible_head.gauges: then `horsehead head CASE --write` computes it"
        }
        (None, _) => {
            "copy it to this place, or name a mesh, flexible_head.mesh_file, to compute it from"
        }
    };
    let tables = [&flexible.modes_file, &flexible.influence_file].into_iter();
    let places = tables.map(|name| folder.join(name));
    let absent = places.filter(|path| !path.exists());
    let fault = |path: PathBuf| CaseError::Missing {
        path: path.into(),
        role: format!(
            "a table of the back head, named in {}",
            document.path.display()
        )
        .into(),
        help: help.into(),
    };
    absent.map(fault).collect()
}

/// Reads the tables of modes and influence lines, with the places of the gauges.
fn tables(folder: &Path, document: &Document, file: &CaseFile) -> Result<ReadHead, CaseError> {
    let flexible = &file.flexible_head;
    let stated = stated_gauges(document, flexible)?;
    let from_mesh = flexible.mesh_file.is_some() && stated.is_some();
    if flexible.modes_file == flexible.influence_file {
        return Err(document.field(
            &["flexible_head", "influence_file"].map(DocumentStep::Key),
            flexible.influence_file.display(),
            "another file than modes_file",
            "give each table a file of its own",
        ));
    }
    let mut faults = Faults::default();
    if let Some(mesh) = &flexible.mesh_file {
        let role = format!(
            "the mesh of the back head, named in {}",
            document.path.display()
        );
        faults.take(file::require_exists(&folder.join(mesh), &role));
    }
    let modes_file = folder.join(&flexible.modes_file);
    let influence_file = folder.join(&flexible.influence_file);
    let mut missing = Faults::default();
    for fault in absent(folder, document, (flexible, stated.is_some())) {
        missing.add(fault);
    }
    let present = missing.end();
    let read = match present.and_then(|()| head::read(&modes_file, &influence_file)) {
        Ok(tables) => Ok(of_tables(
            document,
            (&modes_file, tables),
            (stated, from_mesh),
        )),
        // what is missing or damaged is computed again; a geometry that cannot be is a fault of its own
        Err(fault) => match unreduced(file).filter(|_| from_mesh) {
            Some(head) => Ok(to_be_reduced(head, &modes_file, (stated, fault))),
            None => Err(fault),
        },
    };
    let read = faults.take(read);
    faults.end()?;
    read.ok_or_else(|| damaged(&document.path, "it cannot be read", "copy it again"))
}

/// Returns a head that is to be reduced for the gauges of the case because of a fault of its tables, with the damping and
/// the stations of its modes file where that can be read.
fn to_be_reduced(
    mut head: ModalHead,
    modes_file: &Path,
    (gauges, fault): (Option<[HeadGauge; 4]>, CaseError),
) -> ReadHead {
    if let Ok((damping_ratio, arc_deg)) = head::reduction_settings(modes_file) {
        head = with_stations(arc_deg);
        head.damping_ratio = damping_ratio;
    }
    let provenance = head::Provenance {
        gauges,
        ..head::Provenance::default()
    };
    ReadHead::new(head, provenance, Some(fault))
}

/// Returns a head as its tables have it, which are out of date if the case places the gauges elsewhere.
fn of_tables(
    document: &Document,
    (modes_file, (head, mut provenance)): (&Path, (ModalHead, head::Provenance)),
    (stated, from_mesh): (Option<[HeadGauge; 4]>, bool),
) -> ReadHead {
    let moved = matches!((stated, provenance.gauges), (Some(here), Some(there)) if here != there);
    let stale = moved.then(|| {
        contradiction(
            modes_file,
            "gauges",
            "those for which the tables were computed",
            format!(
                "{}: flexible_head.gauges has others",
                document.path.display()
            ),
            if from_mesh {
                "`horsehead head CASE --write` computes the tables again"
            } else {
                "state the gauges of the tables, or name a mesh, flexible_head.mesh_file, to compute them again"
            },
        )
    });
    provenance.gauges = stated.or(provenance.gauges);
    ReadHead::new(head, provenance, stale)
}

/// Returns the length of the unit in which the mesh is given.
///
/// # Errors
/// Returns an error for a factor that is no unit of length.
fn mesh_unit_m(document: &Document, flexible: &FlexibleHead) -> Result<f64, CaseError> {
    let unit_m = flexible.mesh_unit_m;
    if (1e-6..=1e3).contains(&unit_m) {
        return Ok(unit_m);
    }
    Err(document.field(
        &["flexible_head", "mesh_unit_m"].map(DocumentStep::Key),
        unit_m,
        "the unit's length in metres, 1e-6 to 1e3",
        "state 1.0 for a mesh in metres, 0.001 for millimetres, 0.0254 for inches",
    ))
}

/// Returns the places of the gauges that a case states.
///
/// # Errors
/// Returns an error if they are not those of the gauges 1 to 4.
fn stated_gauges(
    document: &Document,
    flexible: &FlexibleHead,
) -> Result<Option<[HeadGauge; 4]>, CaseError> {
    let Some(gauges) = &flexible.gauges else {
        return Ok(None);
    };
    let keys = ["flexible_head", "gauges"].map(DocumentStep::Key);
    let places = head::places(gauges).filter(|_| gauges.len() == 4);
    let places = places.ok_or_else(|| {
        document.field(
            &keys,
            format!("{{ {} }}", gauges.keys().cloned().collect::<Vec<_>>().join(", ")),
            "the gauges 1, 2, 3 and 4",
            "add gauges.N = { x_m = .., y_m = .., z_m = .., length_m = .. } for each, in the frame of the beam",
        )
    })?;
    for gauge in &places {
        let numbers = gauge.position_m.iter().chain(&gauge.direction);
        // a direction of no length has become not a number
        let finite = numbers.copied().all(f64::is_finite);
        if !(finite && (1e-4..=1.0).contains(&gauge.length_m)) {
            return Err(document.field(
                &keys,
                format!(
                    "{:?}, length {}, direction {:?}",
                    gauge.position_m, gauge.length_m, gauge.direction
                ),
                "finite coordinates in metres, a grid length of 1e-4 to 1 m, and a direction that is \
                 not zero",
                "correct the place; lengths are in metres",
            ));
        }
    }
    Ok(Some(places))
}

/// Damping ratio of the head's modes where no modes file states another: that of welded steel.
const DAMPING_RATIO: f64 = 0.01;

/// Angle by which the stations of the influence lines go beyond the rope's anchor and its last contact \[deg\].
const BEYOND_DEG: f64 = 7.0;

/// Returns a head without modes, with the stations at which it is to be reduced: every degree of the arc that
/// the rope touches. `None` if the crank cannot complete a turn.
fn unreduced(file: &CaseFile) -> Option<ModalHead> {
    let envelope = geometry::envelope(file).ok()?;
    let [lowest, highest] = envelope.contact_deg;
    let first = (lowest.min(file.back_head.rope_anchor_deg) - BEYOND_DEG).floor();
    let count = whole((highest + BEYOND_DEG).ceil() - first) + 1;
    Some(with_stations(
        (0..count).map(|at| first + at as f64).collect(),
    ))
}

/// Returns a head without modes that is to be reduced at the stations `arc_deg`.
fn with_stations(arc_deg: Vec<f64>) -> ModalHead {
    let zero = vec![[0.0; 4]; arc_deg.len()];
    ModalHead {
        frequencies_hz: Vec::new(),
        damping_ratio: DAMPING_RATIO,
        radial: Vec::new(),
        tangential: Vec::new(),
        gauge_stress_mpa: Vec::new(),
        participation: Vec::new(),
        inertia_stress_mpa: [[0.0; 4]; 3],
        stress: StressRecovery::default(),
        mass_kg: 0.0,
        influence: Influence {
            psi_deg: arc_deg.clone(),
            normal_mpa_per_n: zero.clone(),
            tangential_mpa_per_n: zero,
        },
        arc_deg,
    }
}

/// Restricts the stations of a head to the angles that the rope surface of its mesh spans, in equal steps.
fn clip_stations(head: &mut ModalHead, mesh: &mesh::Mesh, arc: &BackHead) {
    /// Distance of the last station from the end of the surface \[deg\].
    const INSIDE_DEG: f64 = 1e-6;
    /// Distance by which a station may be beyond the end of the surface by rounding \[deg\].
    const ROUNDING_DEG: f64 = 1e-2;
    let (Some(&first), Some(&last)) = (head.arc_deg.first(), head.arc_deg.last()) else {
        return;
    };
    let middle = 0.5 * (first + last);
    let nodes = mesh.surfaces.get("rope_surface").into_iter().flatten();
    let angles = nodes.filter_map(|node| {
        let [x, y, _] = mesh.nodes_m.get(*node)?;
        let angle = (y - arc.center_y_m).atan2(x - arc.center_x_m).to_degrees();
        Some(angle + 360.0 * ((middle - angle) / 360.0).round())
    });
    let span = angles.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], angle| {
        [low.min(angle), high.max(angle)]
    });
    let is_cut = [
        span[0] > first + ROUNDING_DEG,
        span[1] < last - ROUNDING_DEG,
    ];
    if is_cut == [false, false] {
        return;
    }
    let from = if is_cut[0] {
        span[0] + INSIDE_DEG
    } else {
        first
    };
    let to = if is_cut[1] {
        span[1] - INSIDE_DEG
    } else {
        last
    };
    // the dynamics need equal steps; the present ones are kept about as long
    let pitch = (last - first) / (head.arc_deg.len().max(2) - 1) as f64;
    let steps = whole(((to - from) / pitch).round()).max(1);
    let station = |at| from + (to - from) * at as f64 / steps as f64;
    let arc_deg: Vec<f64> = (0..=steps).map(station).collect();
    *head = ModalHead {
        damping_ratio: head.damping_ratio,
        stress: head.stress,
        mass_kg: head.mass_kg,
        ..with_stations(arc_deg)
    };
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
        // as it was when all gauges were vertical
        if !head::is_upwards(&gauge.direction) {
            take(&gauge.direction);
        }
    }
    take(&read.head.arc_deg);
    if flexible.mesh_unit_m.to_bits() != 1.0_f64.to_bits() {
        take(&[flexible.mesh_unit_m]);
    }
    hasher.finalize().to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Checks that stations lie on the rope surface, in equal steps of about a degree, wherever the surface ends, also
    /// across the angle where the arc tangent jumps.
    #[test]
    fn stations_end_where_the_rope_surface_ends() {
        let arc = BackHead {
            radius_m: 2.0,
            center_x_m: 0.5,
            center_y_m: -0.5,
            rope_anchor_deg: 130.0,
        };
        let stations = |from: f64, to: f64| {
            let place = |at: u32| {
                let angle = (from + (to - from) * f64::from(at) / 100.0).to_radians();
                [0.5 + 2.0 * angle.cos(), -0.5 + 2.0 * angle.sin(), 0.0]
            };
            let mesh = mesh::Mesh {
                nodes_m: (0..=100).map(place).collect(),
                surfaces: BTreeMap::from([("rope_surface".to_owned(), (0..=100).collect())]),
                ..mesh::Mesh::default()
            };
            let mut head = with_stations((118..=220).map(f64::from).collect());
            clip_stations(&mut head, &mesh, &arc);
            assert_eq!(head.influence.psi_deg, head.arc_deg);
            assert_eq!(head.influence.normal_mpa_per_n.len(), head.arc_deg.len());
            head.arc_deg
        };
        assert_eq!(stations(118.0, 220.0).len(), 103);
        assert_eq!(stations(100.0, 250.0), stations(118.0, 220.0));
        let cut = stations(121.6, 214.3);
        let (first, last) = (cut[0], *cut.last().unwrap());
        assert!((first - 121.6).abs() < 1e-5 && (last - 214.3).abs() < 1e-5);
        assert_eq!(cut.len(), 94);
        let steps: Vec<f64> = cut.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(
            steps.iter().all(|step| (step - steps[0]).abs() < 1e-9),
            "{steps:?}"
        );
        assert!((stations(121.6, 250.0).last().unwrap() - 220.0).abs() < 1e-9);
    }
}
