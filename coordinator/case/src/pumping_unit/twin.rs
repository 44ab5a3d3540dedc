//! Tables of the head for twin ropes (JSON).
//!
//! The tables are valid for one distance of the ropes from the plane and for the stations of the head's other
//! tables. `horsehead head CASE --write` recomputes tables that do not fit; so that this command can read the
//! case, unfit tables are returned in [`Read::unfit`] instead of as an error.
use super::{mesh, schema::TwinRopesEntry};
use crate::{
    document,
    error::{CaseError, contradiction},
    file,
};
use protocol::pumping_unit::{Influence, ModalHead, TwinHead, TwinRopes};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Remedy that errors about the head's tables for twin ropes suggest.
const REMEDY: &str = "`horsehead head CASE --write` computes the tables";

/// Tables of the head for twin ropes, as stored in the file.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TwinFile {
    /// Hash of the mesh file from which the tables were computed.
    pub mesh_blake3: Option<String>,
    /// Hash of all inputs of the modal reduction.
    pub source_blake3: Option<String>,
    /// Name of the program that computed the tables.
    pub made_by: Option<String>,
    /// Distance of each rope from the machine's plane of motion \[m\].
    pub offset_m: f64,
    /// Frequencies of the modes out of the plane \[Hz\].
    pub frequencies_hz: Vec<f64>,
    /// Angles along the rope arc of the head at which the tables have values \[deg\].
    pub arc_deg: Vec<f64>,
    /// Radial displacement of each mode at each station.
    pub radial: Vec<Vec<f64>>,
    /// Tangential displacement of each mode at each station.
    pub tangential: Vec<Vec<f64>>,
    /// Lateral displacement of each mode at each station.
    pub lateral: Vec<Vec<f64>>,
    /// Stress at the four gauges per unit amplitude of each mode \[MPa\].
    pub gauge_stress_mpa: Vec<[f64; 4]>,
    /// Gauge stress per unit normal force at each station \[MPa/N\].
    pub normal_mpa_per_n: Vec<[f64; 4]>,
    /// Gauge stress per unit tangential force at each station \[MPa/N\].
    pub tangential_mpa_per_n: Vec<[f64; 4]>,
    /// Gauge stress per unit lateral force at each station \[MPa/N\].
    pub lateral_mpa_per_n: Vec<[f64; 4]>,
}

/// Settings and tables of twin ropes, and the error that says why the tables cannot be used, if there is one.
pub(super) struct Read {
    pub(super) twins: TwinRopes,
    pub(super) unfit: Option<CaseError>,
}

/// Hashes of the inputs from which the head's tables must have been computed; `None` without a mesh.
#[derive(Clone, Copy)]
pub(super) struct Hashes<'a> {
    /// Hash of the mesh file.
    pub(super) mesh: Option<&'a str>,
    /// Hash of all inputs of the modal reduction.
    pub(super) source: Option<&'a str>,
}

/// Reads the settings and tables of twin ropes.
///
/// # Errors
/// An unreadable or malformed file. Tables that are missing or belong to another head are returned in
/// [`Read::unfit`].
pub(super) fn read(
    folder: &Path,
    entry: &TwinRopesEntry,
    plane: &ModalHead,
    hashes: Hashes<'_>,
) -> Result<Read, CaseError> {
    let path = folder.join(&entry.head_file);
    let with = |head| TwinRopes {
        offset_m: entry.offset_m,
        back_length_difference_m: entry.back_length_difference_m,
        front_length_difference_m: entry.front_length_difference_m,
        modes: entry.modes,
        head,
    };
    if !path.exists() {
        return Ok(Read {
            twins: with(TwinHead::default()),
            unfit: Some(CaseError::Missing {
                path: path.into(),
                role: "the back head's tables for a pair of ropes, `twin_ropes.head_file`".into(),
                help: format!("{REMEDY} from the mesh").into(),
            }),
        });
    }
    let bytes = file::read(&path, "the back head's tables, `twin_ropes.head_file`")?;
    let tables: TwinFile = document::json(&path, &bytes)?;
    check_shapes(&path, &tables)?;
    let unfit = check_fit(&path, &tables, entry, plane)
        .and_then(|()| {
            let stated = tables.mesh_blake3.as_deref();
            mesh::check_origin(&path, mesh::Origin::Mesh, hashes.mesh, stated)
        })
        .and_then(|()| {
            let stated = tables.source_blake3.as_deref();
            mesh::check_origin(&path, mesh::Origin::Source, hashes.source, stated)
        })
        .err();
    Ok(Read {
        twins: with(tables.into_head()),
        unfit,
    })
}

impl TwinFile {
    fn into_head(self) -> TwinHead {
        TwinHead {
            frequencies_hz: self.frequencies_hz,
            radial: self.radial,
            tangential: self.tangential,
            lateral: self.lateral,
            gauge_stress_mpa: self.gauge_stress_mpa,
            influence: Influence {
                psi_deg: self.arc_deg,
                normal_mpa_per_n: self.normal_mpa_per_n,
                tangential_mpa_per_n: self.tangential_mpa_per_n,
            },
            lateral_mpa_per_n: self.lateral_mpa_per_n,
        }
    }
}

/// Checks that the head's tables for twin ropes have one row per mode and one value per station.
fn check_shapes(path: &Path, tables: &TwinFile) -> Result<(), CaseError> {
    let (modes, stations) = (tables.frequencies_hz.len(), tables.arc_deg.len());
    let lengths = [
        ("radial", tables.radial.len(), modes, "modes"),
        ("tangential", tables.tangential.len(), modes, "modes"),
        ("lateral", tables.lateral.len(), modes, "modes"),
        (
            "gauge_stress_mpa",
            tables.gauge_stress_mpa.len(),
            modes,
            "modes",
        ),
        (
            "normal_mpa_per_n",
            tables.normal_mpa_per_n.len(),
            stations,
            "stations",
        ),
        (
            "tangential_mpa_per_n",
            tables.tangential_mpa_per_n.len(),
            stations,
            "stations",
        ),
        (
            "lateral_mpa_per_n",
            tables.lateral_mpa_per_n.len(),
            stations,
            "stations",
        ),
    ];
    let ragged = [&tables.radial, &tables.tangential, &tables.lateral]
        .into_iter()
        .flatten()
        .map(|shape| ("a shape", shape.len(), stations, "stations"));
    let wrong = lengths
        .into_iter()
        .chain(ragged)
        .find(|(_, found, expected, _)| found != expected);
    if let Some((name, found, expected, what)) = wrong {
        return Err(crate::error::damaged(
            path,
            format!("{name} has {found} entries for {expected} {what}"),
            REMEDY,
        ));
    }
    Ok(())
}

/// Checks that the tables belong to the given twin ropes and to the stations of the head's other tables.
fn check_fit(
    path: &Path,
    tables: &TwinFile,
    entry: &TwinRopesEntry,
    plane: &ModalHead,
) -> Result<(), CaseError> {
    if (tables.offset_m - entry.offset_m).abs() > 1e-9 {
        return Err(contradiction(
            path,
            "offset_m",
            tables.offset_m.to_string(),
            format!("case.toml: twin_ropes.offset_m = {}", entry.offset_m),
            &format!("the tables belong to another pair of ropes: {REMEDY} again"),
        ));
    }
    if tables.arc_deg != plane.arc_deg || tables.arc_deg != plane.influence.psi_deg {
        return Err(contradiction(
            path,
            "arc_deg",
            format!("{} stations", tables.arc_deg.len()),
            "the stations in modes_file and influence_file differ".to_owned(),
            &format!("the head's tables belong together: {REMEDY} again"),
        ));
    }
    let available = tables.frequencies_hz.len();
    if entry.modes > available {
        return Err(contradiction(
            path,
            "the number of modes",
            available.to_string(),
            format!("case.toml: twin_ropes.modes = {}", entry.modes),
            &format!("reduce `twin_ropes.modes`, or recompute: {REMEDY} with that many modes"),
        ));
    }
    Ok(())
}
