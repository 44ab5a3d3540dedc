//! The shipped head cut into 10-node tetrahedra, as a mesh file of Gmsh's kind, against the bricks and
//! against `CalculiX`.
use super::*;
use coordinator::case::mesh::Mesh as ReadMesh;
use split::Split;
use std::{collections::BTreeSet, fmt::Write as _, sync::LazyLock};

#[path = "../../worker/simulation/src/flexible/tests/split.rs"]
mod split;

/// Millionths of a metre, without a sign for z: equal for a node and its image.
fn place(&[x, y, z]: &[f64; 3]) -> [i64; 3] {
    #[expect(clippy::cast_possible_truncation, reason = "a head of some metres")]
    let cell = |x: f64| (x * 1e6).round() as i64;
    [cell(x), cell(y), cell(z.abs())]
}

/// A mesh of bricks as a file of 10-node tetrahedra, six to a brick, that is its own mirror image.
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
    let names = blocks.iter().map(|(dim, tag, .., name, _)| format!("{dim} {tag} \"{name}\"\n"));
    let names: String = names.collect();
    let entities = blocks.iter().map(|(_, tag, ..)| format!("{tag} 0 0 0 0 0 0 1 {tag} 0\n"));
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
        writeln!(text, "{dimension} {entity} {kind} {}", elements.len() / nodes).unwrap();
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

/// The head of tetrahedra, reduced once for all tests.
static REDUCED: LazyLock<Reduction> = LazyLock::new(|| {
    let bricks = mesh::read(&folder().join("back_head.msh")).unwrap();
    let file = tempfile::tempdir().unwrap();
    let path = file.path().join("tetrahedra.msh");
    fs::write(&path, as_tetrahedra(&bricks)).unwrap();
    let read = mesh::read(&path).unwrap();
    assert_eq!(read.kind, ReadKind::Tetrahedron);
    assert_eq!(read.volumes[mesh::VOLUME].len() / 10, 6 * 13_838);
    let started = std::time::Instant::now();
    let reduced = reduced_from(&mesh_of(&path), 12, &BOTH);
    eprintln!("{} unknowns {} solves {:?}", reduced.unknowns, reduced.lanczos_steps, started.elapsed());
    reduced
});

#[test]
fn measure() {
    let table = table("back_head_modes_all.json");
    let theirs = numbers(&table["frequencies_hz"]);
    let bricks = reduced(12, &BOTH);
    for (k, (mode, brick)) in REDUCED.modes.iter().zip(&bricks.modes).enumerate() {
        let hz = mode.frequency / std::f64::consts::TAU;
        let brick_hz = brick.frequency / std::f64::consts::TAU;
        let shape = |m: &simulation::flexible::Mode| [&m.radial[..], &m.tangential[..]].concat();
        eprintln!(
            "{k} {:?} {:?} tet {hz:.3} brick {brick_hz:.3} ccx {:.3} tet/ccx {:+.3} % shape {:.6} gauges {:.6} {:?} {:?}",
            mode.family, brick.family, theirs[k], 100.0 * (hz / theirs[k] - 1.0),
            mac(&shape(mode), &shape(brick)), mac(&mode.gauge_stress, &brick.gauge_stress),
            mode.gauge_stress, brick.gauge_stress,
        );
    }
    let lines = rows("back_head_influence.csv");
    for (kind, first) in [(&REDUCED.normal_influence, 1), (&REDUCED.tangential_influence, 5)] {
        for gauge in 0..4 {
            let largest = lines.iter().map(|r| r[first + gauge].abs()).fold(0.0, f64::max);
            let worst = kind.iter().zip(&lines).map(|(o, r)| (o[gauge] * 1e-6 - r[first + gauge]) / largest);
            let worst: Vec<f64> = worst.collect();
            let (lo, hi) = worst.iter().fold((0.0_f64, 0.0_f64), |(l, h), w| (l.min(*w), h.max(*w)));
            let scale: f64 = kind.iter().zip(&lines).map(|(o, r)| o[gauge] * 1e-6 * r[first + gauge]).sum::<f64>()
                / lines.iter().map(|r| r[first + gauge].powi(2)).sum::<f64>();
            eprintln!("line {first} gauge {gauge}: {lo:+.4} .. {hi:+.4} of the largest; scale {scale:.4}");
        }
    }
    for (ours, theirs) in REDUCED.compliance.iter().zip(rows("back_head_static_compliance.csv")) {
        eprintln!("compliance {:?}", ours.iter().zip(&theirs[1..]).map(|(a, b)| a / b).collect::<Vec<_>>());
    }
    eprintln!("mass {} {:?} {}", REDUCED.mass, REDUCED.center_of_mass, REDUCED.inertia);
    eprintln!("{:?} {:?}", REDUCED.inertia_stress, bricks.inertia_stress);
}
