//! Checks the shipped head cut into 10-node tetrahedra and written as a Gmsh file against the bricks and
//! against `CalculiX`, and a mesh made by Gmsh against scikit-fem.
use super::*;
use case::pumping_unit::mesh::Mesh as ReadMesh;
use split::Split;
use std::{collections::BTreeSet, fmt::Write as _};

#[path = "../../worker/simulation/src/flexible/tests/split.rs"]
mod split;

/// Rounds a position to micrometres and drops the sign of z, so that a node and its mirror image are equal.
fn place(&[x, y, z]: &[f64; 3]) -> [i64; 3] {
    #[expect(clippy::cast_possible_truncation, reason = "a head of some metres")]
    let cell = |x: f64| (x * 1e6).round() as i64;
    [cell(x), cell(y), cell(z.abs())]
}

/// Converts a brick mesh to the text of a Gmsh file of 10-node tetrahedra, six per brick, that is symmetric
/// about z = 0.
fn as_tetrahedra(bricks: &ReadMesh) -> String {
    let places: BTreeSet<[i64; 3]> = bricks.nodes_m.iter().map(place).collect();
    let order: Vec<[i64; 3]> = places.into_iter().collect();
    let rank = |node: usize| order.binary_search(&place(&bricks.nodes_m[node])).unwrap();
    let mut split = Split::new(bricks.nodes_m.clone(), rank);
    let mut blocks = Vec::new();
    for (tag, name) in (2..).zip(mesh::SURFACES) {
        blocks.push((2, tag, 9, 6, name, split.triangles(&bricks.surfaces[name])));
    }
    let solid = split.tetrahedra(&bricks.volumes[mesh::VOLUME]);
    blocks.push((3, 1, 11, 10, mesh::VOLUME, solid));
    let mut text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n".to_owned();
    let count = split.nodes.len();
    let names = blocks
        .iter()
        .map(|(dim, tag, .., name, _)| format!("{dim} {tag} \"{name}\"\n"));
    let names: String = names.collect();
    let entities = blocks
        .iter()
        .map(|(_, tag, ..)| format!("{tag} 0 0 0 0 0 0 1 {tag} 0\n"));
    let entities: String = entities.collect();
    write!(
        text,
        "$PhysicalNames\n4\n{names}$EndPhysicalNames\n$Entities\n0 0 3 1\n{entities}$EndEntities\n\
         $Nodes\n1 {count} 1 {count}\n3 1 0 {count}\n"
    )
    .unwrap();
    for tag in 1..=count {
        writeln!(text, "{tag}").unwrap();
    }
    for [x, y, z] in &split.nodes {
        writeln!(text, "{x} {y} {z}").unwrap();
    }
    let total: usize = blocks.iter().map(|(_, _, _, n, _, e)| e.len() / n).sum();
    writeln!(text, "$EndNodes\n$Elements\n4 {total} 1 {total}").unwrap();
    for (dimension, entity, kind, nodes, _, elements) in &blocks {
        writeln!(
            text,
            "{dimension} {entity} {kind} {}",
            elements.len() / nodes
        )
        .unwrap();
        for element in elements.chunks_exact(*nodes) {
            // the tag of an element says nothing
            text.push('1');
            for node in element {
                write!(text, " {}", node + 1).unwrap();
            }
            text.push('\n');
        }
    }
    text.push_str("$EndElements\n");
    text
}

/// Reduction of the tetrahedral mesh to six symmetric modes, computed once for all tests.
static REDUCED: LazyLock<Reduction> = LazyLock::new(|| {
    let bricks = mesh::read(&folder().join("back_head.msh")).unwrap();
    let file = tempfile::tempdir().unwrap();
    let path = file.path().join("tetrahedra.msh");
    fs::write(&path, as_tetrahedra(&bricks)).unwrap();
    let read = mesh_of(&path);
    assert_eq!(read.kind, ElementKind::Tetrahedron);
    assert_eq!(read.elements.len(), 10 * 6 * 13_838);
    reduced_from(&read, 6, &[Family::Symmetric])
});

/// Checks that six modes agree within 1 % with those of `CalculiX` on the bricks, with similar shapes and
/// stresses. Tetrahedra cut from bricks resolve more than the bricks; halving the brick size moves the lowest
/// modes by about 1 %.
#[test]
fn modes_of_tetrahedra_are_those_of_calculix() {
    let table = table("back_head_modes_all.json");
    let frequencies = numbers(&table["frequencies_hz"]);
    let symmetric = (0..24).filter(|k| table["family"][k] == "symmetric");
    for (mode, k) in REDUCED.modes.iter().zip(symmetric) {
        let hz = mode.frequency / std::f64::consts::TAU;
        let share = hz / frequencies[k] - 1.0;
        let ours = [&mode.radial[..], &mode.tangential[..]].concat();
        let theirs = ["radial", "tangential"].map(|of| numbers(&table[of][k]));
        let shapes = mac(&ours, &theirs.concat());
        let gauges = mac(&mode.gauge_stress, &numbers(&table["gauge_stress_mpa"][k]));
        eprintln!(
            "{hz:.2} Hz, {:+.2} %, shape {shapes:.4}, gauges {gauges:.4}",
            100.0 * share
        );
        assert!(share.abs() < 0.01, "mode {k}: {share}");
        assert!(
            shapes > 0.98 && gauges > 0.99,
            "mode {k}: {shapes} {gauges}"
        );
    }
}

/// Checks that influence lines of tetrahedra agree with those of bricks within 4 % of their largest value and
/// within 3 % in a least-squares scale factor; halving the brick size moves gauge 3 by 3 %. Mass, centre of
/// mass and inertia are exact, since both meshes fill the same body.
#[test]
fn statics_of_tetrahedra_are_those_of_bricks() {
    let lines = rows("back_head_influence.csv");
    for (kind, first) in [
        (&REDUCED.normal_influence, 1),
        (&REDUCED.tangential_influence, 5),
    ] {
        for gauge in 0..4 {
            let pairs = kind.iter().zip(&lines);
            let pairs = pairs.map(|(ours, row)| (ours[gauge] * 1e-6, row[first + gauge]));
            let largest = pairs
                .clone()
                .fold(0.0_f64, |most, (_, b)| most.max(b.abs()));
            let worst = pairs
                .clone()
                .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            let fit: f64 = pairs.clone().map(|(a, b)| a * b).sum();
            let scale = fit / pairs.map(|(_, b)| b * b).sum::<f64>();
            eprintln!(
                "gauge {}: scale {scale:.4}, worst {:.4}",
                gauge + 1,
                worst / largest
            );
            assert!(
                worst < 0.04 * largest,
                "gauge {gauge}: {worst} of {largest}"
            );
            assert!((scale - 1.0).abs() < 0.03, "gauge {gauge}: {scale}");
        }
    }
    let published = rows("back_head_static_compliance.csv");
    for (k, (ours, theirs)) in REDUCED.compliance.iter().zip(published).enumerate() {
        // under the load itself the finer mesh gives way more, by 2 to 4 %
        let more = ours[k] / theirs[1 + k] - 1.0;
        assert!((0.0..0.05).contains(&more), "{more}");
    }
    let table = table("back_head_modes.json");
    let published = table["inertia_stress_mpa"].as_array().unwrap();
    for (ours, theirs) in REDUCED.inertia_stress.iter().zip(published) {
        let theirs = numbers(theirs);
        let largest = theirs.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for (ours, theirs) in ours.iter().zip(&theirs) {
            assert!(
                (ours * 1e-6 - theirs).abs() < 0.03 * largest,
                "{ours} {theirs}"
            );
        }
    }
    assert!((REDUCED.mass - 881.016).abs() < 1e-3);
    assert!((REDUCED.center_of_mass[0] + 1.48285).abs() < 1e-5);
    assert!((REDUCED.center_of_mass[1] + 0.32917).abs() < 1e-5);
    assert!((REDUCED.inertia / 2673.3 - 1.0).abs() < 2e-4);
}

/// Checks half an arm with curved edges, meshed by Gmsh, against another finite-element program
/// (`arm/make.py` made both): frequencies, gauge reading of every mode, mass, influence line. Against a
/// reference with the same four integration points the agreement is near rounding error; against one with
/// enough points for curved edges it is limited by the integration error.
#[test]
fn a_mesh_by_gmsh_gives_what_another_program_gives() {
    let arm = Path::new(env!("CARGO_MANIFEST_DIR")).join("back_head/arm");
    let mesh = mesh_of(&arm.join("arm.msh"));
    assert!(mesh.half && mesh.kind == ElementKind::Tetrahedron);
    let reference: serde_json::Value =
        serde_json::from_slice(&fs::read(arm.join("reference.json")).unwrap()).unwrap();
    let gauge = Gauge {
        position: [-0.46, 0.03, 0.04],
        direction: [0.0, 1.0, 0.0],
        length: 0.02,
    };
    let stations = [141.0, 163.0, 180.0, 205.0].map(f64::to_radians);
    let near = |ours: f64, theirs: f64, limit: f64| {
        let error = (ours / theirs - 1.0).abs();
        eprintln!("{ours} {theirs} {error:.1e}");
        assert!(error < limit, "{ours} {theirs}");
    };
    for (family, name) in [
        (Family::Symmetric, "symmetric"),
        (Family::Antisymmetric, "antisymmetric"),
    ] {
        let reduced = reduce(&ReductionRequest {
            mesh: &mesh,
            steel: STEEL,
            gauges: &[gauge],
            center: [0.0, 0.0],
            stations: &stations,
            probes: &[],
            wrap: None,
            pair: None,
            modes: 4,
            families: &[family],
            patterns: &[],
            surface: None,
            fields: false,
        })
        .unwrap();
        for (points, of_frequency, of_gauge, of_line) in [
            ("four_points", 1e-8, 1e-7, 1e-3),
            ("exact", 2e-4, 5e-3, 5e-3),
        ] {
            let theirs = &reference[points];
            let of_family = &theirs[name];
            let frequencies = numbers(&of_family["frequencies_hz"]);
            let readings = numbers(&of_family["gauge_stress_pa"]);
            for (mode, (frequency, reading)) in reduced
                .modes
                .iter()
                .zip(frequencies.into_iter().zip(readings))
            {
                near(
                    mode.frequency / std::f64::consts::TAU,
                    frequency,
                    of_frequency,
                );
                near(mode.gauge_stress[0], reading, of_gauge);
            }
            near(reduced.mass, theirs["mass_kg"].as_f64().unwrap(), 1e-9);
            let lines = numbers(&theirs["normal_influence_pa_per_n"]);
            for (ours, theirs) in reduced.normal_influence.iter().zip(lines) {
                near(ours[0], theirs, of_line);
            }
        }
    }
}
