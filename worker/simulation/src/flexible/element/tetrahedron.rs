//! 10-node tetrahedron: quadratic displacement on straight or curved edges.
//!
//! Nodes are the four corners and six points near the middles of the edges, which also define the element's
//! geometry. In volume coordinates `L_0 + L_1 + L_2 + L_3 = 1` a corner has `N = L (2 L - 1)` and an edge `N
//! = 4 L_a L_b` ([Zienkiewicz2013]). Its strain is linear, so that it can bend; the 4-node tetrahedron, whose
//! strain is constant, locks (one layer is five times too stiff) and is not offered.
//!
//! Stiffness is integrated with 4 points of degree 2, exact for straight edges and free of spurious
//! zero-energy modes; mass with 15 points of degree 5 ([Stroud1971], T3:5-1), exact for straight edges, and
//! exact in the total mass for curved edges. This module knows one element and no mesh.
use super::face::{Face, Triangle};
use super::integral::{add_stiffness, add_weight, extrapolated, jacobian};
use super::interface::{Element, InsideOut, Matrices};
use super::steel::Steel;
use nalgebra::{DMatrix, Matrix3, SMatrix, Vector3};

/// Number of nodes of one element.
const NODES: usize = 10;
/// Number of nodal displacements of one element.
const DOFS: usize = 3 * NODES;
/// End nodes of the edges on which nodes 4 to 9 lie, in Gmsh's order.
pub(super) const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [0, 2], [0, 3], [2, 3], [1, 3]];
/// Gradients of the four volume coordinates; the last three volume coordinates are the reference coordinates.
const DIRECTIONS: [Vector3<f64>; 4] = [
    Vector3::new(-1.0, -1.0, -1.0),
    Vector3::new(1.0, 0.0, 0.0),
    Vector3::new(0.0, 1.0, 0.0),
    Vector3::new(0.0, 0.0, 1.0),
];

/// 10-node tetrahedron element.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tetrahedron;

/// Returns the volume coordinates of a point of the reference tetrahedron.
fn volume_coordinates(&[r, s, t]: &[f64; 3]) -> [f64; 4] {
    [1.0 - r - s - t, r, s, t]
}

/// Returns the ten nodal shape functions at a point of the reference tetrahedron.
fn shape(point: &[f64; 3]) -> [f64; NODES] {
    let l = volume_coordinates(point);
    std::array::from_fn(|node| match node.checked_sub(4) {
        None => l[node] * (2.0 * l[node] - 1.0),
        Some(edge) => {
            let [a, b] = EDGES[edge];
            4.0 * l[a] * l[b]
        }
    })
}

/// Returns the gradients of the shape functions with respect to the reference coordinates.
fn slopes(point: &[f64; 3]) -> [Vector3<f64>; NODES] {
    let l = volume_coordinates(point);
    std::array::from_fn(|node| match node.checked_sub(4) {
        None => DIRECTIONS[node] * (4.0 * l[node] - 1.0),
        Some(edge) => {
            let [a, b] = EDGES[edge];
            DIRECTIONS[a] * (4.0 * l[b]) + DIRECTIONS[b] * (4.0 * l[a])
        }
    })
}

/// Returns the reference coordinates of the point on the line from the centre through `corner` whose other
/// three volume coordinates equal `rest`.
fn towards(corner: usize, rest: f64) -> [f64; 3] {
    let at = |k: usize| {
        if k == corner { 1.0 - 3.0 * rest } else { rest }
    };
    [at(1), at(2), at(3)]
}

/// Returns the quadrature points of degree 2 with their shares of the volume.
pub(super) fn degree_2() -> impl Iterator<Item = ([f64; 3], f64)> {
    let rest = (5.0 - 5.0_f64.sqrt()) / 20.0;
    (0..4).map(move |corner| (towards(corner, rest), 0.25))
}

/// Returns the quadrature points of degree 5 with their shares of the volume: the centre, four points towards
/// the faces, four towards the corners, six towards the edges.
pub(super) fn degree_5() -> impl Iterator<Item = ([f64; 3], f64)> {
    let root = 15.0_f64.sqrt();
    let corners = [-1.0, 1.0].into_iter().flat_map(move |sign| {
        let rest = (7.0 - sign * root) / 34.0;
        let share = (2665.0 + sign * 14.0 * root) / 37800.0;
        (0..4).map(move |corner| (towards(corner, rest), share))
    });
    let edges = EDGES.into_iter().map(move |edge| {
        let at = |k: usize| {
            let sign = if edge.contains(&k) { 1.0 } else { -1.0 };
            (5.0 + sign * root) / 20.0
        };
        ([at(1), at(2), at(3)], 10.0 / 189.0)
    });
    std::iter::once(([0.25; 3], 16.0 / 135.0))
        .chain(corners)
        .chain(edges)
}

impl Element for Tetrahedron {
    fn nodes(&self) -> usize {
        NODES
    }

    fn face(&self) -> &'static dyn Face {
        &Triangle
    }

    fn center(&self) -> [f64; 3] {
        [0.25; 3]
    }

    fn shape(&self, point: &[f64; 3]) -> Vec<f64> {
        shape(point).to_vec()
    }

    fn slopes(&self, point: &[f64; 3]) -> Vec<Vector3<f64>> {
        slopes(point).to_vec()
    }

    fn outside(&self, point: &[f64; 3]) -> f64 {
        let least = volume_coordinates(point).into_iter();
        -least.fold(f64::INFINITY, f64::min)
    }

    fn matrices(&self, nodes: &[[f64; 3]], steel: &Steel) -> Result<Matrices, InsideOut> {
        let mut stiffness = Box::new(SMatrix::<f64, DOFS, DOFS>::zeros());
        for (point, share) in degree_2() {
            let slopes = slopes(&point);
            let jacobian = jacobian(&slopes, nodes);
            let inverse = jacobian.try_inverse().ok_or(InsideOut)?;
            let volume = positive(jacobian.determinant())? * share;
            let gradients = slopes.map(|slope| inverse * slope);
            add_stiffness(&mut stiffness, &gradients, steel.lame(), volume);
        }
        let mut weight = [[0.0; NODES]; NODES];
        for (point, share) in degree_5() {
            let volume = positive(jacobian(&slopes(&point), nodes).determinant())? * share;
            add_weight(&mut weight, &shape(&point), steel.density * volume);
        }
        let mass = |row: usize, column: usize| {
            if row % 3 == column % 3 {
                weight[row / 3][column / 3]
            } else {
                0.0
            }
        };
        Ok(Matrices {
            stiffness: DMatrix::from_column_slice(DOFS, DOFS, stiffness.as_slice()),
            mass: DMatrix::from_fn(DOFS, DOFS, mass),
        })
    }

    fn corner_stress(
        &self,
        nodes: &[[f64; 3]],
        steel: &Steel,
        fields: &[Vec<[f64; 3]>],
    ) -> Result<Vec<Vec<[f64; 6]>>, InsideOut> {
        let gradients = |(point, _): ([f64; 3], f64)| {
            let slopes = slopes(&point);
            let inverse = jacobian(&slopes, nodes).try_inverse().ok_or(InsideOut)?;
            Ok(slopes.map(|slope| inverse * slope))
        };
        let points: Vec<[Vector3<f64>; NODES]> =
            degree_2().map(gradients).collect::<Result<_, _>>()?;
        // a linear function of the volume coordinates, of which the points have `rest` thrice and `most` once
        let rest = (5.0 - 5.0_f64.sqrt()) / 20.0;
        let most = 1.0 - 3.0 * rest;
        let shares: [[f64; 4]; 4] = std::array::from_fn(|corner| {
            std::array::from_fn(|point| {
                let own = if point == corner { 1.0 } else { 0.0 };
                (own - rest) / (most - rest)
            })
        });
        let corners = |field: &Vec<[f64; 3]>| {
            let stress = |gradients: &[Vector3<f64>; NODES]| {
                let mut slope = Matrix3::zeros();
                for (gradient, u) in gradients.iter().zip(field) {
                    slope += Vector3::from(*u) * gradient.transpose();
                }
                steel.stress(&slope)
            };
            let inside: Vec<[f64; 6]> = points.iter().map(stress).collect();
            let corner = |shares: &[f64; 4]| extrapolated(shares, &inside);
            shares.iter().map(corner).collect()
        };
        Ok(fields.iter().map(corners).collect())
    }

    fn faces(&self) -> &'static [[usize; 4]] {
        &[[0, 2, 1, 1], [0, 1, 3, 3], [0, 3, 2, 2], [3, 1, 2, 2]]
    }
}

/// Returns the volume of a tetrahedron from the determinant of its Jacobian, or [`InsideOut`] if the
/// determinant is not positive.
fn positive(determinant: f64) -> Result<f64, InsideOut> {
    if determinant > 0.0 {
        Ok(determinant / 6.0)
    } else {
        Err(InsideOut)
    }
}
