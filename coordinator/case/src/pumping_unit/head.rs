//! Reading of the reduced back head of a case: modes (JSON) and influence lines (CSV), with a check of their
//! shapes.
//!
//! The check of the numbers against the mesh is in [`super::mesh`].
use crate::{
    document,
    error::{CaseError, damaged},
    file,
    table::CsvTable,
};
use protocol::pumping_unit::HeadGauge;
use protocol::pumping_unit::{Influence, ModalHead, StressRecovery};
use serde::{Deserialize, Serialize};
use std::{collections::BTreeMap, path::Path};

/// Keys of the modes file that are used; its other keys, such as centre and inertia, are for human readers.
#[derive(Debug, Deserialize)]
struct ModesFile {
    frequencies_hz: Vec<f64>,
    damping_ratio: f64,
    arc_deg: Vec<f64>,
    radial: Vec<Vec<f64>>,
    tangential: Vec<Vec<f64>>,
    gauge_stress_mpa: Vec<[f64; 4]>,
    participation: Vec<[f64; 3]>,
    inertia_stress_mpa: [[f64; 4]; 3],
    mass_kg: f64,
    /// Locations of the gauges by name, for which the tables were computed.
    gauges: Option<BTreeMap<String, TolerantPlace>>,
    /// Stress of the gauges under the largest tension; absent if the tables were not reduced by this program.
    largest_wrap: Option<WrapStress>,
    /// Content hash of the mesh file that the tables were computed from, if they were.
    mesh_blake3: Option<String>,
    /// Content hash of all inputs of the reduction; absent if the tables were not reduced by this program.
    source_blake3: Option<String>,
}

/// Location of a gauge, in the case file or the modes file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GaugePlace {
    /// Coordinate along the machine, from the beam pivot towards the well \[m\].
    pub x_m: f64,
    /// Upward coordinate of the gauge \[m\].
    pub y_m: f64,
    /// Out-of-plane coordinate of the gauge \[m\].
    pub z_m: f64,
    /// Length of the strain gauge's measuring grid \[m\].
    pub length_m: f64,
    /// Vector along the grid, of any length; upwards unless stated.
    #[serde(default = "upwards", skip_serializing_if = "is_upwards")]
    pub direction: [f64; 3],
}

/// Location of a gauge in a modes file, whose keys other than those of [`GaugePlace`] are ignored.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "serde_json::Map<String, serde_json::Value>")]
struct TolerantPlace(GaugePlace);

impl TryFrom<serde_json::Map<String, serde_json::Value>> for TolerantPlace {
    type Error = serde_json::Error;

    fn try_from(mut keys: serde_json::Map<String, serde_json::Value>) -> Result<Self, Self::Error> {
        const KNOWN: [&str; 5] = ["x_m", "y_m", "z_m", "length_m", "direction"];
        keys.retain(|key, _| KNOWN.contains(&key.as_str()));
        serde_json::from_value(keys.into()).map(Self)
    }
}

/// Returns the unit vector along a direction; a gauge reads the same in the opposite direction, so that the one with a
/// positive y, x or z is taken. A vector that has length 1 up to rounding stays as it is, so that one that was written and
/// read again is the same.
fn unit_vector(direction: [f64; 3]) -> [f64; 3] {
    let square: f64 = direction.iter().map(|x| x * x).sum();
    let length = if (square - 1.0).abs() < 1e-12 {
        1.0
    } else {
        square.sqrt()
    };
    let [x, y, z] = direction;
    let leading = [y, x, z].into_iter().find(|part| part.abs() > 0.0);
    let signed = length.copysign(leading.unwrap_or(1.0));
    // no negative zeros
    direction.map(|part| part / signed + 0.0)
}

/// Direction of a gauge that reads vertical strain.
pub(super) const UPWARDS: [f64; 3] = [0.0, 1.0, 0.0];

const fn upwards() -> [f64; 3] {
    UPWARDS
}

/// Returns whether a gauge reads vertical strain.
pub(super) fn is_upwards(direction: &[f64; 3]) -> bool {
    direction.map(f64::to_bits) == UPWARDS.map(f64::to_bits)
}

impl From<HeadGauge> for GaugePlace {
    fn from(gauge: HeadGauge) -> Self {
        let [x_m, y_m, z_m] = gauge.position_m;
        Self {
            x_m,
            y_m,
            z_m,
            length_m: gauge.length_m,
            direction: gauge.direction,
        }
    }
}

/// Static stress of the gauges under the rope at its largest tension, and what moving a gauge changes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WrapStress {
    /// Tension of the rope \[N\].
    pub tension_n: f64,
    /// Stress of each gauge \[MPa\].
    pub stress_mpa: [f64; 4],
    /// Change of that stress when the gauge is moved along x, y and z [MPa/m]; `None` along an axis on which
    /// the body ends on both sides of the gauge.
    pub gradient_mpa_per_m: [[Option<f64>; 3]; 4],
}

/// Provenance of the head's tables, as stated in the modes file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Provenance {
    /// Locations of the four gauges, if the file states them.
    pub(super) gauges: Option<[HeadGauge; 4]>,
    /// Stress of the gauges under the largest tension, if the file states it.
    pub(super) largest_wrap: Option<WrapStress>,
    /// Content hash of the mesh that the tables were computed from.
    pub(super) mesh_blake3: Option<String>,
    /// Content hash of all inputs of the reduction.
    pub(super) source_blake3: Option<String>,
}

/// Returns the places of the gauges 1 to 4 by their names; `None` if one is missing.
pub(super) fn places(gauges: &BTreeMap<String, GaugePlace>) -> Option<[HeadGauge; 4]> {
    let place = |name: &str| {
        let place = gauges.get(name)?;
        Some(HeadGauge {
            position_m: [place.x_m, place.y_m, place.z_m],
            direction: unit_vector(place.direction),
            length_m: place.length_m,
        })
    };
    Some([place("1")?, place("2")?, place("3")?, place("4")?])
}

impl Provenance {
    fn new(file: &ModesFile) -> Self {
        Self {
            gauges: file.gauges.as_ref().and_then(|gauges| {
                let gauges = gauges.iter();
                places(&gauges.map(|(name, own)| (name.clone(), own.0)).collect())
            }),
            largest_wrap: file.largest_wrap,
            mesh_blake3: file.mesh_blake3.clone(),
            source_blake3: file.source_blake3.clone(),
        }
    }
}

/// Reads modes and influence lines.
///
/// # Errors
/// Returns an error for ragged tables, frequencies or stations that do not ascend, values out of range, and
/// an influence table that does not cover the modes' arc.
pub(super) fn read(modes: &Path, influence: &Path) -> Result<(ModalHead, Provenance), CaseError> {
    let read = modes_file(modes)?;
    let influence = read_influence(influence, &read.arc_deg)?;
    let provenance = Provenance::new(&read);
    let head = ModalHead {
        frequencies_hz: read.frequencies_hz,
        damping_ratio: read.damping_ratio,
        arc_deg: read.arc_deg,
        radial: read.radial,
        tangential: read.tangential,
        gauge_stress_mpa: read.gauge_stress_mpa,
        participation: read.participation,
        inertia_stress_mpa: read.inertia_stress_mpa,
        stress: StressRecovery::default(),
        mass_kg: read.mass_kg,
        influence,
    };
    Ok((head, provenance))
}

/// Reads and checks a modes file.
fn modes_file(path: &Path) -> Result<ModesFile, CaseError> {
    let bytes = file::read(
        path,
        "the modes of the back head, `flexible_head.modes_file`",
    )?;
    let read: ModesFile = document::json(path, &bytes)?;
    check_modes(path, &read)?;
    Ok(read)
}

/// Returns the damping ratio and the stations of a modes file, with which its head is reduced again.
///
/// # Errors
/// As [`read`], for the modes file.
pub(super) fn reduction_settings(modes: &Path) -> Result<(f64, Vec<f64>), CaseError> {
    let read = modes_file(modes)?;
    Ok((read.damping_ratio, read.arc_deg))
}

/// Checks that the head's modes ascend in frequency and have values in range.
fn check_modes(path: &Path, modes: &ModesFile) -> Result<(), CaseError> {
    ascending(&modes.frequencies_hz).map_err(|at| {
        field(
            path,
            &format!("frequencies_hz[{at}]"),
            number(&modes.frequencies_hz, at),
            "positive frequencies in ascending order [Hz]",
            "sort the modes, with all their tables, by frequency",
        )
    })?;
    if !modes
        .frequencies_hz
        .first()
        .is_some_and(|first| *first > 0.0)
    {
        return Err(field(
            path,
            "frequencies_hz[0]",
            number(&modes.frequencies_hz, 0),
            "at least one mode, all above 0 Hz",
            "use modes with both pins held: they have no rigid-body motion",
        ));
    }
    ascending(&modes.arc_deg).map_err(|at| {
        field(
            path,
            &format!("arc_deg[{at}]"),
            number(&modes.arc_deg, at),
            "stations in ascending order [deg]",
            "sort the stations, with the shapes",
        )
    })?;
    if !(0.0..1.0).contains(&modes.damping_ratio) {
        return Err(field(
            path,
            "damping_ratio",
            modes.damping_ratio.to_string(),
            "0 to below 1",
            "give the modal damping ratio; 0.01 is usual for welded steel",
        ));
    }
    if !(modes.mass_kg > 0.0 && modes.mass_kg <= 1.0e5) {
        return Err(field(
            path,
            "mass_kg",
            modes.mass_kg.to_string(),
            "above 0, at most 1e5 kg",
            "give the mass of the meshed steel",
        ));
    }
    check_shapes(path, modes)
}

/// Checks the shape of the head's mode tables: a row of values for every mode, and a value for every station
/// on the arc.
fn check_shapes(path: &Path, modes: &ModesFile) -> Result<(), CaseError> {
    let count = modes.frequencies_hz.len();
    let stations = modes.arc_deg.len();
    if stations < 2 {
        return Err(field(
            path,
            "arc_deg",
            format!("{stations} stations"),
            "at least 2 stations [deg]",
            "give the shapes along the rope arc",
        ));
    }
    let lengths = [
        ("radial", modes.radial.len()),
        ("tangential", modes.tangential.len()),
        ("gauge_stress_mpa", modes.gauge_stress_mpa.len()),
        ("participation", modes.participation.len()),
    ];
    for (name, length) in lengths {
        if length != count {
            return Err(field(
                path,
                name,
                format!("{length} rows"),
                &format!("{count} rows: one per frequency"),
                "the table is ragged: give every mode its row",
            ));
        }
    }
    for (name, shapes) in [("radial", &modes.radial), ("tangential", &modes.tangential)] {
        if let Some(at) = shapes.iter().position(|shape| shape.len() != stations) {
            return Err(field(
                path,
                &format!("{name}[{at}]"),
                format!("{} values", shapes.get(at).map_or(0, Vec::len)),
                &format!("{stations} values: one per station of arc_deg"),
                "the table is ragged: give every station its value",
            ));
        }
    }
    Ok(())
}

/// Builds an error about a value in the modes file.
fn field(path: &Path, field: &str, value: String, allowed: &str, help: &str) -> CaseError {
    CaseError::Field {
        path: path.into(),
        field: field.into(),
        value: value.into(),
        allowed: allowed.into(),
        excerpt: "".into(),
        help: help.into(),
    }
}

/// Reads the head's influence lines: the angle column `psi_deg`, then the stress of the four gauges per unit
/// normal and per unit tangential force.
fn read_influence(path: &Path, arc_deg: &[f64]) -> Result<Influence, CaseError> {
    let bytes = file::read(path, "the influence lines, `flexible_head.influence_file`")?;
    let table = CsvTable::read(
        path,
        &bytes,
        &[
            "psi_deg",
            "normal_1_mpa_per_n",
            "normal_2_mpa_per_n",
            "normal_3_mpa_per_n",
            "normal_4_mpa_per_n",
            "tangential_1_mpa_per_n",
            "tangential_2_mpa_per_n",
            "tangential_3_mpa_per_n",
            "tangential_4_mpa_per_n",
        ],
    )?;
    let Some([psi, n1, n2, n3, n4, t1, t2, t3, t4]) = table.columns.first_chunk::<9>() else {
        return Err(damaged(path, "the table has no columns", "copy it again"));
    };
    ascending(psi).map_err(|at| {
        table.cell(
            path,
            (at, 0),
            number(psi, at),
            "stations in ascending order [deg]",
            "sort the rows by psi_deg",
        )
    })?;
    for (column, values) in table.columns.iter().enumerate().skip(1) {
        // 1 MPa/N would be 100 GPa under the ropes' load
        if let Some(row) = values.iter().position(|value| value.abs() > 0.1) {
            return Err(table.cell(
                path,
                (row, column),
                number(values, row),
                "-0.1 to 0.1 MPa per newton",
                "the lines are stress in MPa per newton of force: check the unit",
            ));
        }
    }
    let ends = |values: &[f64]| Some((*values.first()?, *values.last()?));
    if let (Some((from, to)), Some((first, last))) = (ends(arc_deg), ends(psi))
        && (first > from + 1e-9 || last < to - 1e-9)
    {
        let (row, value, bound) = if first > from + 1e-9 {
            (0, first, format!("at most {from} deg"))
        } else {
            (psi.len() - 1, last, format!("at least {to} deg"))
        };
        return Err(table.cell(
            path,
            (row, 0),
            value.to_string(),
            format!("{bound}: the influence lines must cover the modes' arc, {from} to {to} deg"),
            "compute the missing stations",
        ));
    }
    let rows = |[a, b, c, d]: [&Vec<f64>; 4]| {
        let pairs = a.iter().zip(b).zip(c.iter().zip(d));
        pairs.map(|((a, b), (c, d))| [*a, *b, *c, *d]).collect()
    };
    Ok(Influence {
        psi_deg: psi.clone(),
        normal_mpa_per_n: rows([n1, n2, n3, n4]),
        tangential_mpa_per_n: rows([t1, t2, t3, t4]),
    })
}

/// Checks that numbers ascend strictly; on failure returns the index of the first that does not.
fn ascending(values: &[f64]) -> Result<(), usize> {
    let broken = values
        .iter()
        .zip(values.iter().skip(1))
        .position(|(a, b)| b <= a);
    broken.map_or(Ok(()), |at| Err(at + 1))
}

/// Formats a number of a list for an error message; `absent` if the list is shorter.
fn number(values: &[f64], at: usize) -> String {
    values
        .get(at)
        .map_or_else(|| "absent".to_owned(), ToString::to_string)
}
