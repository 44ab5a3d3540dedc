//! Tests of brick elements on bodies with known solutions, and of the half models against the whole body for
//! every element kind.
mod cholesky;
mod coupling;
mod halves;
mod split;
mod surface;
mod tetrahedra;

use super::{
    assembly::{Assembly, Symmetric, Unknowns},
    cholesky::Factor,
    eigen::{dot, lowest},
    *,
};
use crate::math::elementary::sin_cos;
use nalgebra::DMatrix;

const STEEL: Steel = Steel {
    young: 206.0e9,
    poisson: 0.3,
    density: 7850.0,
};

/// Returns a box of equal bricks starting at `origin`, whose nodes are then moved by `warp`; the face x = min
/// is held, the face x = max is the rope surface.
fn bricks(
    counts: [usize; 3],
    size: [f64; 3],
    origin: [f64; 3],
    warp: impl Fn([f64; 3]) -> [f64; 3],
) -> Mesh {
    let [nx, ny, nz] = counts;
    let node = |i: usize, j: usize, k: usize| (k * (ny + 1) + j) * (nx + 1) + i;
    let mut mesh = Mesh::default();
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                let along = |axis: usize, at: usize| {
                    origin[axis] + size[axis] * at as f64 / counts[axis] as f64
                };
                mesh.nodes
                    .push(warp([along(0, i), along(1, j), along(2, k)]));
                if i == 0 {
                    mesh.held.push(node(i, j, k));
                }
            }
        }
    }
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let square = |k: usize| {
                    [
                        node(i, j, k),
                        node(i + 1, j, k),
                        node(i + 1, j + 1, k),
                        node(i, j + 1, k),
                    ]
                };
                let [a, b, c, d] = square(k);
                let [e, f, g, h] = square(k + 1);
                mesh.elements.extend([a, b, c, d, e, f, g, h]);
                if i == nx - 1 {
                    mesh.rope_faces.extend([b, c, g, f]);
                }
            }
        }
    }
    mesh
}

/// Moves interior points of the box 0..1 x 0..2 x 0..1.5, not its surface, by up to 6 % of a brick.
fn distort([x, y, z]: [f64; 3]) -> [f64; 3] {
    let bump = x * (1.0 - x) * y * (2.0 - y) * z * (1.5 - z);
    let wave = |phase: f64| 0.4 * bump * sin_cos(phase + 3.1 * x + 2.3 * y + 4.7 * z).0;
    [x + wave(0.3), y + wave(1.9), z + wave(4.0)]
}

fn problem(mesh: &Mesh) -> (Unknowns, Assembly) {
    let held = |node: usize| mesh.held.contains(&node);
    let unknowns = Unknowns::new(mesh.nodes.len(), |node, _| !held(node));
    let assembly = Assembly::new(mesh, &STEEL, &unknowns).unwrap();
    (unknowns, assembly)
}

/// Checks the patch test: under a linear displacement of distorted elements no interior node carries a force,
/// and every element has the stress given by Hooke's law.
#[test]
fn distorted_bricks_pass_the_patch_test() {
    assert_eq!(
        patch(bricks([4, 3, 3], [1.0, 2.0, 1.5], [0.0; 3], distort)),
        12
    );
}

/// Runs the patch test on a mesh of the box 1 x 2 x 1.5; returns the number of interior nodes.
fn patch(mut mesh: Mesh) -> usize {
    mesh.held.clear();
    let slope = [
        [3.0e-4, -1.0e-4, 2.0e-4],
        [5.0e-4, -2.0e-4, 7.0e-4],
        [-4.0e-4, 6.0e-4, 1.0e-4],
    ];
    let field: Vec<[f64; 3]> = mesh
        .nodes
        .iter()
        .map(|x| slope.map(|row| dot(&row, x)))
        .collect();
    let (unknowns, assembly) = problem(&mesh);
    let forces = unknowns.spread(&assembly.stiffness.times(&unknowns.gather(&field)));
    let inner = |n: &[f64; 3]| {
        let sides = n.iter().zip([1.0, 2.0, 1.5]);
        sides.clone().all(|(x, size)| *x > 1e-9 && *x < size - 1e-9)
    };
    let largest = |inside: bool| {
        let chosen = mesh
            .nodes
            .iter()
            .zip(&forces)
            .filter(|(n, _)| inner(n) == inside);
        chosen
            .flat_map(|(_, f)| *f)
            .fold(0.0_f64, |most, f| most.max(f.abs()))
    };
    assert!(
        largest(false) > 1e6 && largest(true) < 1e-9 * largest(false),
        "{}",
        largest(true)
    );

    let shear = 206.0e9 / 2.6;
    let first = 2.0 * shear * 0.3 / 0.4;
    let pressure = first * (slope[0][0] + slope[1][1] + slope[2][2]);
    let expected = [
        pressure + 2.0 * shear * slope[0][0],
        pressure + 2.0 * shear * slope[1][1],
        pressure + 2.0 * shear * slope[2][2],
        shear * (slope[0][1] + slope[1][0]),
        shear * (slope[1][2] + slope[2][1]),
        shear * (slope[2][0] + slope[0][2]),
    ];
    for element in mesh.elements() {
        let moved: Vec<[f64; 3]> = element.iter().map(|&node| field[node]).collect();
        let stress = mesh
            .law()
            .center_stress(&STEEL, &mesh.places(element), &moved);
        for (ours, theirs) in stress.iter().zip(expected) {
            assert!(
                (ours - theirs).abs() < 1e-6 * shear * 1e-3,
                "{ours} {theirs}"
            );
        }
        let corners = mesh
            .law()
            .corner_stress(&mesh.places(element), &STEEL, &[moved])
            .unwrap();
        for stress in &corners[0] {
            for (ours, theirs) in stress.iter().zip(expected) {
                assert!(
                    (ours - theirs).abs() < 1e-6 * shear * 1e-3,
                    "corner: {ours} {theirs}"
                );
            }
        }
    }
    mesh.nodes.iter().filter(|n| inner(n)).count()
}

/// Checks that one brick over the height bends like a beam; without the incompatible modes it would be half
/// as stiff again.
#[test]
fn a_row_of_bricks_bends_like_a_beam() {
    let share = deflection(&bricks([20, 1, 1], BEAM, [0.0; 3], |x| x));
    assert!((share - 1.0).abs() < 0.02, "{share}");
}

/// Length, height and width of the beam whose bending is tested \[m\].
const BEAM: [f64; 3] = [2.0, 0.1, 0.08];

/// Returns the tip deflection of [`BEAM`] under a tip force, divided by that of beam theory with shear.
fn deflection(mesh: &Mesh) -> f64 {
    let [length, height, width] = BEAM;
    let (unknowns, assembly) = problem(mesh);
    let mut load = vec![[0.0; 3]; mesh.nodes.len()];
    let tip: Vec<usize> = (0..mesh.nodes.len())
        .filter(|&n| mesh.nodes[n][0] > length - 1e-9)
        .collect();
    for &node in &tip {
        load[node][1] = 1000.0 / tip.len() as f64;
    }
    let mut answer = unknowns.gather(&load);
    Factor::new(&assembly.stiffness).unwrap().solve(&mut answer);
    let deflection = unknowns.spread(&answer)[tip[0]][1];
    let bending = length.powi(3) / (3.0 * 206.0e9 * width * height.powi(3) / 12.0);
    let shear = length / (5.0 / 6.0 * 206.0e9 / 2.6 * width * height);
    deflection / (1000.0 * (bending + shear))
}

#[test]
fn a_cantilever_rings_at_its_natural_frequencies() {
    for share in cantilever(&bricks([40, 2, 2], CANTILEVER, [0.0; 3], |x| x)) {
        // rotary inertia and shear, which the slender beam has not, take up to 0.5 %
        assert!((0.99..1.005).contains(&share), "{share}");
    }
}

/// Length, height and width of the cantilever whose frequencies are tested \[m\].
const CANTILEVER: [f64; 3] = [3.0, 0.1, 0.06];

/// Returns the four lowest frequencies of [`CANTILEVER`] divided by those of the slender beam; checks that
/// the modes are orthogonal.
fn cantilever(mesh: &Mesh) -> [f64; 4] {
    let [length, height, width] = CANTILEVER;
    let (_, assembly) = problem(mesh);
    let factor = Factor::new(&assembly.stiffness).unwrap();
    let modes = lowest(&assembly, &factor, 4).unwrap();
    // across the width, across the height, second ones of both: roots of cos x cosh x = -1
    let bend = |root: f64, depth: f64| {
        root.powi(2) / length.powi(2) * (206.0e9 * depth * depth / 12.0 / 7850.0).sqrt()
    };
    let (first, second) = (1.875_104_07, 4.694_091_13);
    let mut beam = [first, second]
        .map(|r| [bend(r, width), bend(r, height)])
        .concat();
    beam.sort_by(f64::total_cmp);
    for (i, a) in modes.shapes.iter().enumerate() {
        let weighed = assembly.mass.times(a);
        let stiff = assembly.stiffness.times(a);
        for (j, b) in modes.shapes.iter().enumerate() {
            let unit = if i == j { 1.0 } else { 0.0 };
            assert!((dot(&weighed, b) - unit).abs() < 1e-10);
            let energy = dot(&stiff, b) / modes.eigenvalues[j];
            assert!((energy - unit).abs() < 1e-7, "{i} {j} {energy}");
        }
    }
    std::array::from_fn(|k| modes.eigenvalues[k].sqrt() / beam[k])
}

/// Checks the coupling of the head's modes to the beam: clamped modes with their participation factors,
/// combined with a rigid rotation, must have the frequencies of a bar hinged at its end.
#[test]
fn held_modes_that_turn_with_their_base_ring_like_a_hinged_bar() {
    let [length, height, width] = CANTILEVER;
    let origin = [0.0, -0.5 * height, -0.5 * width];
    let mesh = bricks([40, 2, 2], CANTILEVER, origin, |x| x);
    let modes = reduce(&request(&mesh, &[], &[Family::Symmetric]))
        .unwrap()
        .modes;
    let section = STEEL.density * height * width;
    let inertia = section * length * (length * length + 0.25 * height * height) / 3.0;
    let size = modes.len() + 1;
    let mass = DMatrix::from_fn(size, size, |i, j| match (i.min(j), i.max(j)) {
        (0, 0) => inertia,
        (0, k) => modes[k - 1].participation[2],
        (i, j) => f64::from(u8::from(i == j)),
    });
    let stiffness = DMatrix::from_fn(size, size, |i, j| {
        if i == j && i > 0 {
            modes[i - 1].frequency.powi(2)
        } else {
            0.0
        }
    });
    let root = mass.cholesky().unwrap().l().try_inverse().unwrap();
    let mut found = (&root * stiffness * root.transpose()).symmetric_eigenvalues();
    found.as_mut_slice().sort_by(f64::total_cmp);
    // roots of tan x = tanh x
    for (rate, root) in found.iter().skip(1).zip([3.926_602_31_f64, 7.068_582_75]) {
        let bar =
            root.powi(2) / length.powi(2) * (206.0e9 * height * height / 12.0 / 7850.0).sqrt();
        let share = rate.sqrt() / bar;
        assert!((0.98..1.01).contains(&share), "{share}");
    }
}

fn request<'a>(
    mesh: &'a Mesh,
    gauges: &'a [Gauge],
    families: &'a [Family],
) -> ReductionRequest<'a> {
    ReductionRequest {
        mesh,
        steel: STEEL,
        gauges,
        center: [0.0, 0.0],
        stations: &[],
        probes: &[],
        wrap: None,
        pair: None,
        modes: 8,
        families,
        patterns: &[],
        surface: None,
        fields: true,
    }
}

/// Returns an irregular block that is symmetric about z = 0, far enough from the origin that its end face is
/// an arc of a few degrees about the origin.
fn mirrored() -> Mesh {
    let warp = |[x, y, z]: [f64; 3]| [x + 0.1 * y * y, y * (1.0 + 0.3 * x), z * (1.2 - 0.2 * x)];
    bricks([6, 2, 4], [0.9, 0.2, 0.4], [-1.0, 0.05, -0.2], warp)
}

/// Returns the volume of a body, computed from its mass under a translation along x.
fn assembly_volume(mesh: &Mesh) -> f64 {
    let unknowns = Unknowns::new(mesh.nodes.len(), |_, axis| axis == 0);
    let mass: Symmetric = Assembly::new(mesh, &STEEL, &unknowns).unwrap().mass;
    let ones = vec![1.0; unknowns.len()];
    dot(&mass.times(&ones), &ones) / STEEL.density
}
