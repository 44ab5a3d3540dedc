//! Files written from a reduced head: the tables of the case, and a VTU file for `ParaView`.
use anyhow::Context as _;
use case::pumping_unit::{GaugePlace, HeadSource, TwinFile, WrapStress};
use protocol::pumping_unit::{HeadGauge, HeadMesh, Machine, ModeFamily, ReducedHead, TwinHead};
use report::pumping_unit::vtu::{self, Field};
use run::manifest::PROGRAM;
use serde::Serialize;
use std::{
    collections::BTreeMap,
    fmt::Write as _,
    fs::{self, File},
    io::{BufWriter, Write as _},
    path::{Path, PathBuf},
};
use support::atomic_file::Draft;

/// JSON layout of a case's file with the modes of its back head.
#[derive(Debug, Serialize)]
struct ModesFile<'a> {
    mesh_blake3: &'a str,
    source_blake3: &'a str,
    made_by: &'static str,
    frequencies_hz: Vec<f64>,
    family: Vec<ModeFamily>,
    damping_ratio: f64,
    arc_deg: &'a [f64],
    radial: Vec<&'a [f64]>,
    tangential: Vec<&'a [f64]>,
    gauge_stress_mpa: Vec<[f64; 4]>,
    participation: Vec<[f64; 3]>,
    mass_kg: f64,
    centre_of_mass_m: [f64; 2],
    inertia_about_pivot_kg_m2: f64,
    inertia_stress_mpa: [[f64; 4]; 3],
    gauges: BTreeMap<String, GaugePlace>,
    largest_wrap: WrapStress,
}

/// Replaces the tables of a case (modes file, influence file, and the twin rope file where there is one) and
/// returns their paths.
pub(crate) fn write_tables(
    machine: &Machine,
    source: &HeadSource,
    (head, tension_n): (&ReducedHead, f64),
) -> anyhow::Result<Vec<PathBuf>> {
    let place =
        |(number, gauge): (usize, &HeadGauge)| (number.to_string(), GaugePlace::from(*gauge));
    let file = ModesFile {
        mesh_blake3: &source.mesh_blake3,
        source_blake3: &source.source_blake3,
        made_by: PROGRAM,
        frequencies_hz: head.modes.iter().map(|m| m.frequency_hz).collect(),
        family: head.modes.iter().map(|m| m.family).collect(),
        damping_ratio: machine.modal_head.damping_ratio,
        arc_deg: &head.influence.psi_deg,
        radial: head.modes.iter().map(|m| &m.radial[..]).collect(),
        tangential: head.modes.iter().map(|m| &m.tangential[..]).collect(),
        gauge_stress_mpa: head.modes.iter().map(|m| m.gauge_stress_mpa).collect(),
        participation: head.modes.iter().map(|m| m.participation).collect(),
        mass_kg: head.mass_kg,
        centre_of_mass_m: head.center_of_mass_m,
        inertia_about_pivot_kg_m2: head.inertia_about_pivot_kg_m2,
        inertia_stress_mpa: head.inertia_stress_mpa,
        gauges: (1..).zip(&source.gauges).map(place).collect(),
        largest_wrap: WrapStress {
            tension_n,
            stress_mpa: head.wrap_stress_mpa,
            gradient_mpa_per_m: head.wrap_gradient_mpa_per_m,
        },
    };
    let mut modes = serde_json::to_string(&file)?;
    modes.push('\n');
    let mut all = vec![
        (&source.modes_file, modes),
        (&source.influence_file, influence(head)),
    ];
    let pair = source.twin_file.as_ref().zip(machine.twin_ropes.as_ref());
    if let (Some((path, ropes)), Some(tables)) = (pair, &head.twin) {
        let file = twin_file(source, ropes.offset_m, tables);
        all.push((path, serde_json::to_string(&file)? + "\n"));
    }
    // all are complete before any replaces what was there
    let mut drafts = Vec::new();
    for (path, text) in all {
        let folder = path.parent().unwrap_or(path);
        fs::create_dir_all(folder).with_context(|| cannot_write(folder))?;
        let draft = Draft::new(path, text.as_bytes());
        drafts.push((draft.with_context(|| cannot_write(path))?, path.clone()));
    }
    let mut written = Vec::new();
    for (draft, path) in drafts {
        draft.publish().with_context(|| cannot_write(&path))?;
        written.push(path);
    }
    Ok(written)
}

fn twin_file(source: &HeadSource, offset_m: f64, tables: &TwinHead) -> TwinFile {
    let tables = tables.clone();
    TwinFile {
        mesh_blake3: Some(source.mesh_blake3.clone()),
        source_blake3: Some(source.source_blake3.clone()),
        made_by: Some(PROGRAM.to_owned()),
        offset_m,
        frequencies_hz: tables.frequencies_hz,
        arc_deg: tables.influence.psi_deg,
        radial: tables.radial,
        tangential: tables.tangential,
        lateral: tables.lateral,
        gauge_stress_mpa: tables.gauge_stress_mpa,
        normal_mpa_per_n: tables.influence.normal_mpa_per_n,
        tangential_mpa_per_n: tables.influence.tangential_mpa_per_n,
        lateral_mpa_per_n: tables.lateral_mpa_per_n,
    }
}

fn cannot_write(path: &Path) -> String {
    format!("cannot write {}", path.display())
}

/// Returns the influence lines of the reduced head's gauges as CSV text.
fn influence(head: &ReducedHead) -> String {
    let mut text = "psi_deg".to_owned();
    for kind in ["normal", "tangential"] {
        for gauge in 1..=4 {
            let _infallible = write!(text, ",{kind}_{gauge}_mpa_per_n");
        }
    }
    text.push('\n');
    let lines = &head.influence;
    let rows = lines
        .normal_mpa_per_n
        .iter()
        .zip(&lines.tangential_mpa_per_n);
    for (psi, (normal, tangential)) in lines.psi_deg.iter().zip(rows) {
        let _infallible = write!(text, "{psi}");
        for value in normal.iter().chain(tangential) {
            let _infallible = write!(text, ",{value:e}");
        }
        text.push('\n');
    }
    text
}

/// Writes the modes, displacement and stress of a reduced head to `head.vtu` in a folder, which is created if
/// it does not exist.
pub(crate) fn write_vtu(
    folder: &Path,
    mesh: &HeadMesh,
    head: &ReducedHead,
) -> anyhow::Result<PathBuf> {
    let fields = head
        .fields
        .as_ref()
        .context("the worker returned no fields")?;
    let mut at_nodes = vec![Field::new(
        "displacement under the rope (m)",
        &fields.wrap_m,
    )];
    let named = (1..).zip(head.modes.iter().zip(&fields.modes));
    at_nodes.extend(named.map(|(number, (mode, shape))| {
        Field::new(
            format!("mode {number:02}, {:.1} Hz", mode.frequency_hz),
            shape,
        )
    }));
    let equivalent: Vec<[f32; 1]> = fields.wrap_stress_mpa.iter().map(von_mises).collect();
    let at_elements = [
        Field::new("stress xx yy zz xy yz zx (MPa)", &fields.wrap_stress_mpa),
        Field::new("von Mises stress (MPa)", &equivalent),
    ];
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let path = folder.join("head.vtu");
    let problem = || format!("cannot write {}", path.display());
    let mut to = BufWriter::new(File::create(&path).with_context(problem)?);
    vtu::write(&mut to, mesh, &at_nodes, &at_elements)
        .and_then(|()| to.flush())
        .with_context(problem)?;
    Ok(path)
}

/// Computes the von Mises stress of the components xx, yy, zz, xy, yz, zx.
fn von_mises(stress: &[f32; 6]) -> [f32; 1] {
    let [xx, yy, zz, xy, yz, zx] = stress;
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    let shear = xy * xy + yz * yz + zx * zx;
    [(0.5 * normal + 3.0 * shear).sqrt()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equivalent_stress_of_pull_and_of_shear() {
        assert!((von_mises(&[-7.0, 0.0, 0.0, 0.0, 0.0, 0.0])[0] - 7.0).abs() < 1e-6);
        let shear = von_mises(&[2.0, 2.0, 2.0, 0.0, 3.0, 0.0])[0];
        assert!((shear - 3.0 * 3.0_f32.sqrt()).abs() < 1e-5);
    }
}
