//! Tests of a single tetrahedron (quadrature rules, rigid motions, mass, inverse map) and of the cut through
//! a triangular face.
use super::face::{Face, Triangle};
use super::interface::InsideOut;
use super::tetrahedron::{EDGES, degree_2, degree_5};
use super::{ElementKind, Steel};
use nalgebra::{DVector, Vector3};

const STEEL: Steel = Steel {
    young: 206.0e9,
    poisson: 0.3,
    density: 7850.0,
};

/// Returns the ten nodes of the reference tetrahedron, each moved by the map `place`.
fn tetrahedron(place: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<[f64; 3]> {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let middles = EDGES.map(|[a, b]| [0, 1, 2].map(|k| 0.5 * (corners[a][k] + corners[b][k])));
    corners.into_iter().chain(middles).map(place).collect()
}

/// Maps the reference tetrahedron to one with straight edges and no right angle.
fn straight([x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        1.1 * x + 0.2 * y - 0.1 * z,
        0.3 * x + 0.9 * y + 0.2 * z + 0.4,
        0.8 * z - 0.2 * x,
    ]
}

/// Maps the reference tetrahedron to one with curved edges; the map is quadratic, hence represented exactly
/// by ten nodes.
fn curved([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x + 0.4 * y * z, y + 0.3 * x * x, z]
}

fn factorial(n: i32) -> f64 {
    (1..=n).map(f64::from).product()
}

/// Checks that each quadrature rule integrates `r^a s^b t^c`, whose integral is `a! b! c! / (a + b + c +
/// 3)!`, exactly up to the stated degree and not beyond.
#[test]
fn rules_are_exact_to_their_degree_and_no_further() {
    for degree in [2, 5] {
        let rule: Vec<([f64; 3], f64)> = match degree {
            2 => degree_2().collect(),
            _ => degree_5().collect(),
        };
        assert!(
            rule.iter()
                .all(|(p, w)| *w > 0.0 && p.iter().all(|x| *x > 0.0))
        );
        let mut beyond = 0.0_f64;
        for total in 0..=degree + 1 {
            for a in 0..=total {
                for b in 0..=total - a {
                    let c = total - a - b;
                    let value = |p: &[f64; 3]| p[0].powi(a) * p[1].powi(b) * p[2].powi(c);
                    let sum: f64 = rule.iter().map(|(p, w)| w / 6.0 * value(p)).sum();
                    let exact = factorial(a) * factorial(b) * factorial(c) / factorial(total + 3);
                    let error = (sum / exact - 1.0).abs();
                    if total <= degree {
                        assert!(error < 1e-13, "degree {degree}: {a} {b} {c}: {error:e}");
                    } else {
                        beyond = beyond.max(error);
                    }
                }
            }
        }
        assert!(beyond > 1e-3, "degree {degree} is more: {beyond:e}");
    }
}

/// Checks that the stiffness has exactly six modes of zero energy, the rigid motions.
#[test]
fn only_rigid_motions_cost_no_energy() {
    let law = ElementKind::Tetrahedron.law();
    for (nodes, name) in [
        (tetrahedron(straight), "straight"),
        (tetrahedron(curved), "curved"),
    ] {
        let stiffness = law.matrices(&nodes, &STEEL).unwrap().stiffness;
        assert!((&stiffness - stiffness.transpose()).amax() < 1e-12 * stiffness.amax());
        for k in 0..6 {
            let motion = |[x, y, z]: [f64; 3]| match k {
                0 => [1.0, 0.0, 0.0],
                1 => [0.0, 1.0, 0.0],
                2 => [0.0, 0.0, 1.0],
                3 => [-y, x, 0.0],
                4 => [0.0, -z, y],
                _ => [z, 0.0, -x],
            };
            let field: Vec<f64> = nodes.iter().flat_map(|&node| motion(node)).collect();
            let force = &stiffness * DVector::from_vec(field);
            assert!(force.amax() < 1e-11 * stiffness.amax(), "{name} {k}");
        }
        let mut values: Vec<f64> = stiffness.symmetric_eigenvalues().iter().copied().collect();
        values.sort_by(f64::total_cmp);
        let largest = values[29];
        assert!(values[5].abs() < 1e-12 * largest, "{name}");
        assert!(
            values[6] > 1e-4 * largest,
            "{name} {:e}",
            values[6] / largest
        );
    }
}

/// Checks that the mass matrix gives density times volume for a rigid translation and the right centre of
/// mass, with curved edges too. The Jacobian of [`curved`] has the determinant `1 - 0.24 x z`.
#[test]
fn mass_is_density_times_volume_with_curved_edges() {
    let nodes = tetrahedron(curved);
    let law = ElementKind::Tetrahedron.law();
    let mass = law.matrices(&nodes, &STEEL).unwrap().mass;
    let field = |value: &dyn Fn(&[f64; 3]) -> [f64; 3]| {
        DVector::from_vec(nodes.iter().flat_map(value).collect::<Vec<f64>>())
    };
    for axis in 0..3 {
        let unit = |k: usize| if k == axis { 1.0 } else { 0.0 };
        let moved = field(&|_| [unit(0), unit(1), unit(2)]);
        let volume = moved.dot(&(&mass * &moved)) / STEEL.density;
        let exact = 1.0 / 6.0 - 0.24 / 120.0;
        assert!((volume / exact - 1.0).abs() < 1e-14, "{volume} {exact}");
        // integral of z (1 - 0.24 x z): z is not moved
        let lever = field(&|node| [unit(0) * node[2], unit(1) * node[2], unit(2) * node[2]]);
        let first = moved.dot(&(&mass * lever)) / STEEL.density;
        let exact = 1.0 / 24.0 - 0.24 * 2.0 / 720.0;
        assert!((first / exact - 1.0).abs() < 1e-14, "{first} {exact}");
    }
}

#[test]
fn an_element_that_is_turned_over_or_folded_is_inside_out() {
    let law = ElementKind::Tetrahedron.law();
    let mirrored = tetrahedron(|[x, y, z]| [x, y, -z]);
    assert_eq!(law.matrices(&mirrored, &STEEL).unwrap_err(), InsideOut);
    // the corners are in order, but the middle of an edge lies beyond its end
    let folded = tetrahedron(|[x, y, z]| [x + 4.0 * x * y * (1.0 - z), y, z]);
    assert!(law.matrices(&folded, &STEEL).is_ok(), "bent, not folded");
    let folded = tetrahedron(|[x, y, z]| [x, y - 6.0 * x * y, z]);
    assert_eq!(law.matrices(&folded, &STEEL).unwrap_err(), InsideOut);
}

/// Checks that the inverse map returns the reference coordinates of a position, for points inside and
/// outside.
#[test]
fn places_are_found_in_a_curved_element() {
    let nodes = tetrahedron(curved);
    let law = ElementKind::Tetrahedron.law();
    for point in [[0.1, 0.2, 0.6], [0.31, 0.33, 0.3], [0.05, 0.9, 0.2]] {
        let place = Vector3::from(curved(point));
        let found = law.invert(&nodes, &place).unwrap();
        for (a, b) in found.iter().zip(point) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
        let outside = point.iter().sum::<f64>() > 1.0;
        assert_eq!(law.outside(&found) > 0.0, outside);
    }
}

/// Checks that a cut through a triangle with straight edges reproduces the mean and the values of a quadratic
/// field exactly, at any angle.
#[test]
fn a_cut_through_a_triangle_is_quadratic() {
    // angle and height of the nodes: corners, then middles of 01, 12, 20
    let corners = [[2.0, -0.1], [2.3, 0.05], [2.05, 0.3]];
    let middle = |a: usize, b: usize| [0, 1].map(|k| 0.5 * (corners[a][k] + corners[b][k]));
    let places = [
        corners[0],
        corners[1],
        corners[2],
        middle(0, 1),
        middle(1, 2),
        middle(2, 0),
    ];
    let seen = |node: usize| places[node];
    let value = |[angle, height]: [f64; 2]| {
        0.3 + 2.0 * angle - height + 4.0 * height * height + 3.0 * angle * height - angle * angle
    };
    let sum = |nodes: &[(usize, f64)], share: f64| -> f64 {
        nodes
            .iter()
            .map(|&(n, s)| share * s * value(places[n]))
            .sum()
    };
    let face = [0, 1, 2, 3, 4, 5];
    for psi in [2.01, 2.05, 2.12, 2.29] {
        let cut = Triangle.cut(&face, &seen, psi).unwrap();
        let [p, q] = cut.ends();
        for t in [0.0, 0.3, 0.8, 1.0] {
            let height = p + t * (q - p);
            let found: f64 = cut.at(height).iter().map(|(c, s)| sum(&c.nodes, *s)).sum();
            assert!((found - value([psi, height])).abs() < 1e-12, "{psi} {t}");
        }
        let mean: f64 = cut.points().map(|(c, s)| sum(&c.nodes, s)).sum();
        // Simpson's rule on the exact values: of degree 3
        let exact = [(p, 1.0), (0.5 * (p + q), 4.0), (q, 1.0)];
        let exact: f64 = exact.iter().map(|(z, w)| w / 6.0 * value([psi, *z])).sum();
        assert!((mean - exact).abs() < 1e-12, "{psi}");
    }
    assert!(Triangle.cut(&face, &seen, 1.99).is_none());
    assert!(Triangle.cut(&face, &seen, 2.31).is_none());
}

/// Checks that the ends of a cut on curved edges lie at the interpolated angle and not at that of the chord.
#[test]
fn a_bent_edge_is_cut_where_its_angle_is() {
    let angles = [2.0, 2.4, 2.1, 2.17, 2.31, 2.05];
    let heights = [0.0, 0.1, 0.4, 0.06, 0.2, 0.19];
    let seen = |node: usize| [angles[node], heights[node]];
    for psi in [2.001, 2.07, 2.1, 2.2, 2.39] {
        let cut = Triangle.cut(&[0, 1, 2, 3, 4, 5], &seen, psi).unwrap();
        let points: Vec<_> = cut.points().collect();
        for end in [points[0].0, points[2].0] {
            let angle: f64 = end.nodes.iter().map(|&(n, s)| s * angles[n]).sum();
            assert!((angle - psi).abs() < 1e-12, "{angle} {psi}");
            let whole: f64 = end.nodes.iter().map(|(_, s)| s).sum();
            assert!((whole - 1.0).abs() < 1e-12);
        }
    }
}
