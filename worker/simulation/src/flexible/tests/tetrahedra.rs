//! Tests of quadratic tetrahedra on bodies with known solutions, compared with the bricks that they were
//! divided from.
use super::{split::Split, *};
use std::collections::BTreeSet;

/// Returns the key of a node position: coordinates in micrometres, z without sign, so that mirror images have
/// equal keys.
fn place(&[x, y, z]: &[f64; 3]) -> [i64; 3] {
    #[expect(clippy::cast_possible_truncation, reason = "bodies of some metres")]
    let cell = |x: f64| (x * 1e6).round() as i64;
    [cell(x), cell(y), cell(z.abs())]
}

/// Divides every brick into six tetrahedra with straight edges; the result is symmetric about z = 0 if the
/// bricks are.
pub(super) fn of_bricks(bricks: &Mesh) -> Mesh {
    let places: BTreeSet<[i64; 3]> = bricks.nodes.iter().map(place).collect();
    let order: Vec<[i64; 3]> = places.into_iter().collect();
    let ranks = bricks
        .nodes
        .iter()
        .map(|node| order.binary_search(&place(node)).unwrap());
    let ranks: Vec<usize> = ranks.collect();
    let mut split = Split::new(bricks.nodes.clone(), |node| ranks[node]);
    let elements = split.tetrahedra(&bricks.elements);
    let rim = split.triangles(&bricks.rope_faces);
    let held: BTreeSet<usize> = bricks.held.iter().copied().collect();
    let between = split.middles.iter();
    let between = between.filter(|(ends, _)| ends.iter().all(|end| held.contains(end)));
    let held = held
        .iter()
        .copied()
        .chain(between.map(|(_, &middle)| middle));
    Mesh {
        kind: ElementKind::Tetrahedron,
        held: held.collect(),
        elements,
        rope_faces: rim,
        half: bricks.half,
        nodes: split.nodes,
    }
}

#[test]
fn distorted_tetrahedra_pass_the_patch_test() {
    let mesh = of_bricks(&bricks([4, 3, 3], [1.0, 2.0, 1.5], [0.0; 3], distort));
    // 7 x 5 x 5 places of half a brick, all within
    assert_eq!(patch(mesh), 175);
}

/// Checks that one layer of tetrahedra bends like a beam; 4-node tetrahedra would be almost five times too
/// stiff.
#[test]
fn a_row_of_tetrahedra_bends_like_a_beam() {
    for (n, limit) in [(1, 0.015), (2, 0.008)] {
        let bricks = bricks([20 * n, n, n], BEAM, [0.0; 3], |x| x);
        let (ours, theirs) = (deflection(&of_bricks(&bricks)), deflection(&bricks));
        assert!(
            (ours - 1.0).abs() < limit,
            "tetrahedra {ours}, bricks {theirs}"
        );
    }
}

/// Checks that the frequencies are as close to the slender beam as those of bricks, and closer to a finer
/// mesh than those of the bricks they were divided from.
#[test]
fn a_cantilever_of_tetrahedra_rings_at_its_natural_frequencies() {
    let coarse = bricks([40, 2, 2], CANTILEVER, [0.0; 3], |x| x);
    let fine = bricks([80, 4, 4], CANTILEVER, [0.0; 3], |x| x);
    let [ours, theirs, fine] = [&of_bricks(&coarse), &coarse, &fine].map(cantilever);
    for k in 0..4 {
        assert!((0.99..1.005).contains(&ours[k]), "{ours:?}");
        let [ours, theirs] = [ours, theirs].map(|of| (of[k] / fine[k] - 1.0).abs());
        assert!(ours < 1e-3 && ours < 0.6 * theirs, "{ours} {theirs}");
    }
}

/// Checks the order of convergence on a box between frictionless walls, whose standing waves have no singular
/// corner. The lowest is a shear wave over the two longer sides: `omega^2 = (mu / rho) pi^2 (1 / a^2 + 1 /
/// b^2)`. Its computed square converges from above with the fourth power of the size of tetrahedra, and with
/// the second power of that of bricks.
#[test]
fn frequencies_converge_with_the_fourth_power_of_the_size() {
    let sides = [1.0, 1.3, 0.7];
    let exact = 206.0e9 / 2.6 / 7850.0
        * std::f64::consts::PI.powi(2)
        * (1.0 / sides[0] / sides[0] + 1.0 / sides[1] / sides[1]);
    let excess = |mesh: &Mesh| {
        let within = |x: f64, side: f64| x > 1e-9 && x < side - 1e-9;
        let free = |node: usize, axis: usize| within(mesh.nodes[node][axis], sides[axis]);
        let unknowns = Unknowns::new(mesh.nodes.len(), free);
        let assembly = Assembly::new(mesh, &STEEL, &unknowns).unwrap();
        let factor = Factor::new(&assembly.stiffness).unwrap();
        lowest(&assembly, &factor, 1).unwrap().eigenvalues[0] / exact - 1.0
    };
    let box_of = |n: usize| bricks([n, n, n], sides, [0.0; 3], |x| x);
    let bricks = [4, 8].map(|n| excess(&box_of(n)));
    let tetrahedra = [4, 8].map(|n| excess(&of_bricks(&box_of(n))));
    for (order, [coarse, fine]) in [(2.0, bricks), (4.0, tetrahedra)] {
        let observed = (coarse / fine).log2();
        assert!(
            (observed - order).abs() < 0.3,
            "{coarse} {fine}: {observed}"
        );
    }
    assert!(tetrahedra[1] > 0.0 && tetrahedra[1] < 0.05 * bricks[1].abs());
}

/// Checks that curved edges give volume and frequencies of a round body where straight edges do not: a
/// quarter ring of a few elements, against many bricks.
#[test]
fn curved_edges_make_a_body_round() {
    let (inner, outer, width) = (0.45, 0.55, 0.08);
    let quarter = std::f64::consts::FRAC_PI_2;
    let around = |[angle, radius, z]: [f64; 3]| {
        let (s, c) = sin_cos(angle);
        [radius * s, radius * c, z]
    };
    let flat = |counts| {
        bricks(
            counts,
            [quarter, outer - inner, width],
            [0.0, inner, 0.0],
            |x| x,
        )
    };
    let bend = |mut mesh: Mesh| {
        for node in &mut mesh.nodes {
            *node = around(*node);
        }
        mesh
    };
    let straight = of_bricks(&bend(flat([8, 2, 1])));
    let curved = bend(of_bricks(&flat([8, 2, 1])));
    let fine = bend(flat([48, 6, 4]));
    let ring = 0.5 * quarter * (outer * outer - inner * inner) * width;
    let volumes = [&straight, &curved].map(|mesh| assembly_volume(mesh) / ring - 1.0);
    assert!(volumes[0] < -5e-3 && volumes[1].abs() < 1e-5, "{volumes:?}");
    let frequencies = [&straight, &curved, &fine].map(|mesh| {
        let (_, assembly) = problem(mesh);
        let factor = Factor::new(&assembly.stiffness).unwrap();
        let modes = lowest(&assembly, &factor, 2).unwrap();
        [0, 1].map(|k| modes.eigenvalues[k].sqrt() / std::f64::consts::TAU)
    });
    let [straight, curved, fine] = frequencies;
    for k in 0..2 {
        let errors = [straight, curved].map(|of| (of[k] / fine[k] - 1.0).abs());
        assert!(errors[1] < 0.02 && errors[1] < errors[0], "{errors:?}");
    }
}
